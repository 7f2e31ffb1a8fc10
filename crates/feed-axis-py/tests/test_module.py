"""The module as a whole: what it gives, and its words."""

import inspect

import feed_axis as fa


def test_everything_public_has_words() -> None:
    without: list[str] = []
    for name in fa.__all__:
        thing = getattr(fa, name)
        if isinstance(thing, (str, dict)):
            continue
        members = vars(thing).items() if inspect.isclass(thing) else []
        public = [(f"{name}.{member}", value) for member, value in members if member[0] != "_"]
        all_words = [(name, thing), *public]
        without += [where for where, value in all_words if not inspect.getdoc(value)]
    assert not without


def test_names_are_those_of_the_compiled_module() -> None:
    compiled = {name for name in vars(fa._feed_axis) if not name.startswith("_")}
    assert compiled == set(fa.__all__) - {"__version__"}


def test_strategies_have_words() -> None:
    assert all(words for words in fa.STRATEGIES.values())
