"""The results as Markdown."""

import numpy as np

REACH = ("clean", "in terms", "beyond terms")


def share(count, of):
    return f"{count} of {of}" if of else "–"


def row_of(name, rows):
    """One searcher on the cases that it ran."""
    ran = [(r, r["by"][name]) for r in rows if r["by"][name] and "failed" not in r["by"][name]]
    cells = [name, str(len(ran))]
    clean = [b for r, b in ran if r["reach"] == "clean"]
    cells.append(share(sum(not b["false"] for b in clean), len(clean)))
    for reach in REACH[1:]:
        part = [b for r, b in ran if r["reach"] == reach and r["hidden"] != ["law"]]
        cells.append(share(sum(b["right"] for b in part), len(part)))
    alone = [b for r, b in ran if r["hidden"] and r["hidden"] != ["law"]]
    cells.append(share(sum(b["right"] and not b["false"] for b in alone), len(alone)))
    laws = [b for r, b in ran if r["hidden"] == ["law"]]
    cells.append(share(sum(b["variable"] for b in laws), len(laws)))
    cells.append(f"{np.mean([len(b['false']) for _, b in ran]):.2f}" if ran else "–")
    errors = [b["size_error"] for _, b in ran if b["size_error"] is not None]
    cells.append(f"{100 * np.median(errors):.1f} % ({len(errors)})" if errors else "–")
    cells.append(f"{np.median([b['cpu_s'] for _, b in ran]):.1f}" if ran else "–")
    return "| " + " | ".join(cells) + " |"


HEAD = "| | cases | clean, nothing said falsely | right name, in terms | right name, beyond terms | right and nothing false | law of no library: its variable | false names a case | median size error (of) | processor time a case, s |"


def cases(rows):
    names = list(rows[0]["by"])
    both = [r for r in rows if r["by"]["discover"] and "failed" not in r["by"]["discover"]]
    text = [f"All {len(rows)} cases:", "", HEAD, "|" + "---|" * 10, *(row_of(n, rows) for n in names if n != "discover")]
    if both:
        text += ["", f"The {len(both)} that `discover` ran:", "", HEAD, "|" + "---|" * 10, *(row_of(n, both) for n in names)]
    return text


def each(rows):
    """Every case in a line."""
    names = list(rows[0]["by"])
    text = ["| case | machine | hidden | " + " | ".join(names) + " |", "|" + "---|" * (3 + len(names))]
    for r in rows:
        said = []
        for n in names:
            b = r["by"][n]
            if not b or "failed" in b:
                said.append("not run" if not b else "refused")
                continue
            mark = "✓ " if b["right"] else ""
            said.append(mark + (", ".join(b["names"]) or "nothing"))
        text.append(f"| {r['case']} | {r['machine']} | {', '.join(r['hidden']) or 'nothing'} | " + " | ".join(said) + " |")
    return text


def real(results):
    text = ["| | mass, kg | viscous, N·s/m | dry, N | offset, N | force error on the check log | processor time, s |", "|" + "---|" * 7]
    number = lambda v: "–" if v is None else f"{v:.1f}"
    for name, r in results.items():
        if r:
            p = r["parameters"]
            text.append(f"| {name} | " + " | ".join(number(p.get(k)) for k in ("a", "v", "s", "1")) + f" | {number(r['check_percent'])} % | {number(r['cpu_s'])} |")
    return text


def markdown(written):
    parts = [f"Seed {written['seed']}.", "", *cases(written["cases"]), "", *each(written["cases"])]
    if written["emps"]:
        parts += ["", "EMPS:", "", *real(written["emps"])]
    return "\n".join(parts) + "\n"
