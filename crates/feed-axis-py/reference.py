#!/usr/bin/env python3
"""docs/python-reference.md, from the docstrings of the type stubs.

    crates/feed-axis-py/reference.py            writes the page
    crates/feed-axis-py/reference.py --check    exit 1 if the page is not current
"""

import ast
import inspect
import sys
from pathlib import Path

CRATE = Path(__file__).resolve().parent
STUBS = CRATE / "python/feed_axis/_feed_axis.pyi"
PAGE = CRATE.parents[1] / "docs/python-reference.md"
HEAD = """# Python reference

<!-- written by crates/feed-axis-py/reference.py from the type stubs -->

Every class and function of the module `feed_axis`, here `fa`. Units are SI; the last part of a name is its unit. An introduction: [Python](python.md).
"""
# What stands for a type that only the stubs name.
WORDS = {
    "_Floats": "array",
    "_Path": "path",
    "_Progress": "function",
    "_Motion": "Move | SCurve | Program | array | (array, array)",
    "_Columns": "dict",
    "_Whole": "int",
    "_Layers": "int | ints",
    "_Reference": "(float, float, float)",
    "_Log": "log",
    "_Toolpath": "Toolpath | G-code | array",
    "_Estimate": "(float, float)",
    "ArrayLike": "array-like",
}
# What the pages of classes say in a sentence, if anything.
UNWRITTEN = {"__eq__", "__hash__"}


def words(node):
    text = ast.unparse(node)
    for name, word in WORDS.items():
        text = text.replace(name, word)
    return text


def text_of(node):
    """A docstring as Markdown: lines of `>>>` become a block."""
    doc = ast.get_docstring(node)
    if not doc:
        sys.exit(f"{STUBS}:{node.lineno}: {node.name} has no docstring")
    lines, inside = [], False
    for line in inspect.cleandoc(doc).splitlines():
        example = line.startswith(">>> ")
        if example != inside:
            lines.append("```python" if example else "```")
        inside = example
        lines.append(line.removeprefix(">>> "))
    return "\n".join(lines + ["```"] * inside)


def call(node, owner):
    """How a function is called, with the types of its arguments."""
    made = node.name == "__new__"
    name = owner if made else ".".join(filter(None, [owner, node.name]))
    arguments = node.args
    static = any(ast.unparse(d) == "staticmethod" for d in node.decorator_list)
    first = 1 if owner and not static else 0
    positional = arguments.posonlyargs + arguments.args
    defaults = [None] * (len(positional) - len(arguments.defaults)) + arguments.defaults
    told = [argument(a, d) for a, d in zip(positional, defaults)][first:]
    if arguments.kwonlyargs:
        told += ["*"] + [argument(a, d) for a, d in zip(arguments.kwonlyargs, arguments.kw_defaults)]
    gives = owner if made else words(node.returns)
    line = f"{name}({', '.join(told)}) -> {gives}"
    if len(line) <= 100:
        return line
    return f"{name}(\n" + "".join(f"    {one},\n" for one in told) + f") -> {gives}"


def argument(name, default):
    text = f"{name.arg}: {words(name.annotation)}" if name.annotation else name.arg
    return text if default is None else f"{text} = {ast.unparse(default)}"


def is_property(node):
    return any(ast.unparse(d) == "property" for d in node.decorator_list)


def public(body):
    shown = [n for n in body if isinstance(n, (ast.ClassDef, ast.FunctionDef)) and n.name not in UNWRITTEN]
    return [n for n in shown if not n.name.startswith("_") or n.name.startswith("__")]


def cell(text):
    return " ".join(text.split()).replace("|", "\\|")


def class_text(node):
    parts = [f"## {node.name}", text_of(node)]
    members = public(node.body)
    properties = [n for n in members if is_property(n)]
    if properties:
        rows = [f"| `{n.name}` | `{cell(words(n.returns))}` | {cell(text_of(n))} |" for n in properties]
        parts.append("\n".join(["| property | type | what |", "|---|---|---|", *rows]))
    for one in (n for n in members if not is_property(n)):
        parts += [f"```text\n{call(one, node.name)}\n```", text_of(one)]
    return "\n\n".join(parts)


def page():
    shown = public(ast.parse(STUBS.read_text()).body)
    errors = [n for n in shown if isinstance(n, ast.ClassDef) and n.name.endswith("Error")]
    others = [n for n in shown if n not in errors]
    parts = [HEAD.rstrip()]
    for node in others:
        is_class = isinstance(node, ast.ClassDef)
        parts.append(class_text(node) if is_class else f"## {node.name}\n\n```text\n{call(node, '')}\n```\n\n{text_of(node)}")
    rows = [f"| `{n.name}` | `{words(n.bases[0])}` | {cell(text_of(n))} |" for n in errors]
    parts.append("\n".join(["## Errors", "", "| error | is a | when |", "|---|---|---|", *rows]))
    parts.append(
        "## Constants\n\n`STRATEGIES`: the strategies of `Compensator` by name, each with a line of words. `__version__`: the version."
    )
    return "\n\n".join(parts) + "\n"


def main():
    if sys.argv[1:] == ["--check"]:
        if PAGE.read_text() != page():
            sys.exit(f"{PAGE} is not current: run {Path(__file__).relative_to(PAGE.parents[1])}")
        print(f"{PAGE.name}: current")
    elif sys.argv[1:]:
        sys.exit(__doc__)
    else:
        PAGE.write_text(page())


main()
