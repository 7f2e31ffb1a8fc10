"""Runs the commands that the pages show, and checks the built book.

    book.py run [PAGE...]    sh blocks of the README and of the book, in order
    book.py site MDBOOK      builds the book and follows its links

Blocks of a page:
  ```sh         runs, in one temporary folder per page, where the project's folders are and `cargo xtask`
                is the program that was built. A block that fails fails the page.
  ```sh,fails   likewise, of commands that must fail; what they print is standard error as well.
  ```text       straight behind such a block: what it prints. Every line must be there, in this order;
                three dots stand for the rest of a line, or alone for any number of lines; spaces count as one.
  ```LANGUAGE,save=FILE, ```LANGUAGE,append=FILE
                blocks that a reader saves as a file, or adds to its end.
  ```toml,change=FILE
                lines that a reader changes in a file: each stands for the one of its key, or of the key in its
                comment, `# in place of KEY`.
  ```sh,ignore  does not run; a comment before it says why: <!-- not run: ... -->
A line of commands must mean the same in bash, PowerShell and cmd: no comment, no wildcard, no variable, no backslash, no single quote.
A line with a command that a page names as <!-- not run: `COMMAND`: why --> is left out of its blocks.
A page with <!-- goes on from PAGE.md --> finds the files that the blocks of that page have made.
"""

import os
import re
import subprocess
import sys
import tempfile
import time
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parent.parent
BOOK = ROOT / "target/book"
# What a page's commands find beside them.
FOLDERS = ["crates", "data", "docs", "tests"]
LONGEST_S = 600
# What PowerShell or cmd read otherwise than bash: comments, continued lines, wildcards and `~` that the shell replaces,
# variables, single quotes, `&&`, and a program named by `./`.
BASH_ONLY = re.compile(r"(?:^|\s)#|\\|[*?']|(?:^|\s)~/|\$|&&|^\./")


def pages():
    """The README, then the pages in the order of the book, then the READMEs of crates."""
    summary = (ROOT / "docs/SUMMARY.md").read_text()
    named = [ROOT / "docs" / name for name in re.findall(r"\]\(([^)]+\.md)\)", summary)]
    return [ROOT / "README.md", *named, *sorted(ROOT.glob("crates/*/README.md"))]


def change(file, lines):
    """Puts each of these lines of TOML in the place of the one of its key."""
    whole = file.read_text()
    for line in lines.splitlines():
        key = (re.search(r"# in place of (\w+)", line) or re.match(r"(\w+)", line))[1]
        whole, count = re.subn(rf"(?m)^{key} = .*", line, whole)
        if count != 1:
            sys.exit(f"{file}: {key} stands there {count} times")
    file.write_text(whole)


def blocks(text):
    """(line, language, text, line before it that is not empty, whether only empty lines lie between it and the last)."""
    found, inside, before, follows = [], None, "", False
    for number, line in enumerate(text.splitlines(), 1):
        fence = re.match(r"( *)```(.*)", line)
        if inside is None and fence:
            inside = (number, fence[2].strip(), [], before, follows, len(fence[1]))
        elif inside is not None and fence and not fence[2]:
            at, language, lines, said, after, _ = inside
            found.append((at, language, "\n".join(lines), said, after))
            inside, before, follows = None, "", True
        elif inside is not None:
            inside[2].append(line[inside[5]:])
        elif line.strip():
            before, follows = line.strip(), False
    if inside is not None:
        sys.exit(f"line {inside[0]}: a block that does not end")
    return found


def pattern(shown):
    """What is shown, as an expression that a program's output must hold."""
    lines = []
    for line in shown.strip("\n").splitlines():
        words = [".*" if word == "..." else re.escape(word) for word in line.split()]
        lines.append(r"(?:.*\n)*?" if line.strip() == "..." else r"[ \t]*" + r"[ \t]+".join(words) + r"[ \t]*\n")
    return re.compile(r"^" + "".join(lines), re.MULTILINE)


def shims(folder):
    """Programs as a user has them: `feed-axis`, and `cargo xtask`, which must not build anything here."""
    built = ROOT / "target/debug"
    (folder / "feed-axis").symlink_to(built / "feed-axis")
    cargo = folder / "cargo"
    cargo.write_text(
        '#!/bin/sh\nif [ "$1" = xtask ]; then shift; exec "%s" "$@"; fi\n'
        'echo "cargo $*: only cargo xtask runs here; mark the block sh,ignore and say why" >&2\nexit 1\n' % (built / "xtask")
    )
    cargo.chmod(0o755)


class PageError(Exception):
    """A command that ends otherwise than its page says."""


def folders(page, scratch, made, wrong):
    """The folder of a page's commands, with what the page before it has made; and how many of its blocks ran."""
    if page in made:
        return made[page], 0
    text = page.read_text()
    before = re.search(r"<!-- goes on from (\S+\.md) -->", text)
    if before:
        work, ran = folders((page.parent / before[1]).resolve(), scratch, made, wrong)
    else:
        work, ran = Path(tempfile.mkdtemp(prefix=f"{page.stem}-", dir=scratch)), 0
        for folder in FOLDERS:
            (work / folder).symlink_to(ROOT / folder)
    made[page] = work
    try:
        ran += run_page(page, text, work, scratch, wrong)
    except PageError as error:
        wrong.append(error)
        print(error, flush=True)
    return work, ran


def run_page(page, text, work, scratch, wrong):
    """Runs a page's blocks; how many. What a page shows and a command does not print goes into `wrong`, and the next
    block runs, so that one run finds all of them."""
    name = page.relative_to(ROOT)
    begin, ran, output = time.monotonic(), 0, None
    left_out = re.findall(r"<!-- not run: `([^`]+)`: .+ -->", text)
    env = dict(os.environ, PATH=f"{scratch / 'bin'}:{os.environ['PATH']}", HOME=str(scratch), NO_COLOR="1")
    for line, language, block, before, follows in blocks(text):
        where = f"{name}:{line}"
        if language.split(",")[0] == "sh" and (one := next(filter(BASH_ONLY.search, block.splitlines()), None)):
            sys.exit(f"{where}: PowerShell or cmd read this otherwise than bash; name each file, comment in the text:\n{one}")
        if language in ("sh", "sh,fails"):
            lines = [line for line in block.splitlines() if not any(command in line for command in left_out)]
            output, ran = run_block(where, "\n".join(lines), work, env, language == "sh,fails"), ran + 1
        elif language == "text" and follows and output is not None:
            if not pattern(block).search(output):
                wrong.append(where)
                print(f"{where}: the page shows\n{block}\nthe command printed\n{output}", flush=True)
        elif changed := re.fullmatch(r"toml,change=([\w.-]+)", language):
            change(work / changed[1], block)
        elif kept := re.fullmatch(r"\w+,(save|append)=([\w.-]+)", language):
            with (work / kept[2]).open("w" if kept[1] == "save" else "a") as file:
                file.write(block + "\n")
        elif language in ("bash", "shell", "console"):
            sys.exit(f"{where}: a block of commands is ```sh, so that it runs")
        elif language.startswith("sh,") and (language != "sh,ignore" or not before.startswith("<!-- not run:")):
            sys.exit(f"{where}: a block that does not run is ```sh,ignore behind <!-- not run: why -->")
        if language not in ("sh", "sh,fails"):
            output = None
    if ran:
        print(f"{name}: {ran} blocks, {time.monotonic() - begin:.1f} s", flush=True)
    return ran


def run_block(where, text, work, env, fails):
    """Standard output of a block, and standard error of one that must fail."""
    command = ["bash", "-euo", "pipefail", "-c", text]
    try:
        done = subprocess.run(command, cwd=work, env=env, capture_output=True, text=True, timeout=LONGEST_S)
    except subprocess.TimeoutExpired:
        raise PageError(f"{where}: still running after {LONGEST_S} s\n{text}")
    if fails != bool(done.returncode):
        raise PageError(f"{where}: ends with {done.returncode}\n{text}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr if fails else done.stdout


def run(named):
    """Every page that has blocks, or those named."""
    begin, total, made, wrong = time.monotonic(), 0, {}, []
    with tempfile.TemporaryDirectory(prefix="book-") as scratch:
        programs = Path(scratch, "bin")
        programs.mkdir()
        shims(programs)
        for page in [Path(name).resolve() for name in named] or pages():
            total += folders(page, Path(scratch), made, wrong)[1]
    if wrong:
        sys.exit(f"{len(wrong)} blocks did not do what the pages say (above)")
    print(f"{total} blocks of the pages did what the pages say, {time.monotonic() - begin:.0f} s")


class Page(HTMLParser):
    """Links and places of a built page."""

    def __init__(self, file):
        super().__init__()
        self.links, self.loaded, self.places = [], [], set()
        self.feed(file.read_text())

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.places.update(named[key] for key in ("id", "name") if named.get(key))
        if tag == "a" and named.get("href"):
            self.links.append(named["href"])
        for key in ("src", "href"):
            if tag != "a" and named.get(key):
                self.loaded.append(named[key])


def site(mdbook):
    """Builds the book; what mdbook warns of, and every link that leads nowhere, is a fault."""
    done = subprocess.run([mdbook, "build", str(ROOT)], capture_output=True, text=True)
    said = done.stdout + done.stderr
    if done.returncode or re.search(r"\b(WARN|ERROR)\b", said):
        sys.exit(said)
    # print.html is all pages in one; 404.html has a base of its own.
    built = [file for file in sorted(BOOK.rglob("*.html")) if file.name not in ("print.html", "404.html")]
    for file in built:
        point_at_repository(file)
    files = {file: Page(file) for file in built}
    faults = [f"{file.relative_to(BOOK)}: {fault}" for file, page in files.items() for fault in broken(file, page, files)]
    faults += [f"README.md: {fault}" for fault in broken_readme()]
    if faults:
        sys.exit("\n".join(faults))
    links = sum(len(page.links) for page in files.values())
    print(f"{BOOK / 'index.html'}: {len(files)} pages, {links} links, none broken")


def point_at_repository(file):
    """Links that leave the folder of the pages lead to the repository's files from where the book is built."""
    page = ROOT / "docs" / file.relative_to(BOOK)

    def pointed(found):
        path, mark, place = found[1].partition("#")
        to = (page.parent / unquote(path)).resolve()
        # mdbook takes every page for one of the book.
        there = [to, to.with_suffix(".md")]
        target = next((one for one in there if one.is_file() and ROOT / "docs" not in one.parents), None)
        return found[0] if target is None else f'href="{os.path.relpath(target, file.parent)}{mark}{place}"'

    text = file.read_text()
    file.write_text(re.sub(r'href="((?!https?:|mailto:|#)[^"]+)"', pointed, text))


def broken(file, page, files):
    """Links of a page that lead nowhere, and what it would fetch over the network."""
    for address in page.loaded:
        if re.match(r"(https?:)?//", address):
            yield f"loads {address} over the network"
        elif not address.startswith("data:") and not (file.parent / unquote(address.split("?")[0].split("#")[0])).exists():
            yield f"loads {address}, which is not there"
    for link in page.links:
        if re.match(r"(https?|mailto):", link):
            continue
        path, _, place = link.partition("#")
        to = (file.parent / unquote(path)).resolve() if path else file
        if not to.exists():
            yield f"{link}: no such page"
        elif place and to in files and unquote(place) not in files[to].places:
            yield f"{link}: no such place on that page"


def broken_readme():
    """The README's links are to files of the repository."""
    for link in re.findall(r"\]\(([^)#]+)[^)]*\)", (ROOT / "README.md").read_text()):
        if not link.startswith("http") and not (ROOT / link).exists():
            yield f"{link}: no such file"


if __name__ == "__main__":
    {"run": lambda: run(sys.argv[2:]), "site": lambda: site(sys.argv[2])}[sys.argv[1]]()
