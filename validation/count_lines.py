#!/usr/bin/env python3
"""Lines of product code of each crate, in the working tree or in any commit.

    python validation/count_lines.py
    python validation/count_lines.py --rev 83285a6 --rev HEAD

A line counts if something stands on it after comments, doc comments and items under `#[cfg(test)]`, files of their own
included, are taken away. Counted are the Rust files below `crates/*/src` and the Python files below
`crates/palpate-python/python`, without docstrings; tests, benches, examples and data are not. Needs git and nothing else.
"""

import argparse
import ast
import re
import subprocess
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# What may hold signs that look like code or comments: comments, then texts, then single characters.
SKIPPED = re.compile(
    r"""(?P<line>//[^\n]*)
    |(?P<block>/\*)
    |(?P<raw>\b(?:br|cr|r)(?P<hashes>\#*)".*?"(?P=hashes))
    |(?P<text>"(?:\\.|[^"\\])*")
    |(?P<char>'(?:\\[^\n]{1,9}?|[^'\\\n])')""",
    re.VERBOSE | re.DOTALL,
)


def blanked(text: str, letter: str) -> str:
    """The same lines, with `letter` for everything that is no blank."""
    return re.sub(r"\S", letter, text)


def code_of(text: str) -> str:
    """Rust without comments; what literals hold is replaced by x."""
    parts, at = [], 0
    while match := SKIPPED.search(text, at):
        parts.append(text[at : match.start()])
        end = match.end()
        if match["block"]:
            depth, end = 1, match.end()
            while depth and (mark := re.compile(r"/\*|\*/").search(text, end)):
                depth += 1 if mark[0] == "/*" else -1
                end = mark.end()
        comment = match["line"] or match["block"]
        parts.append(blanked(text[match.start() : end], " " if comment else "x"))
        at = end
    return "".join(parts) + text[at:]


def without_tests(code: str) -> str:
    """Rust without items under `#[cfg(test)]`."""
    attribute = re.compile(r"#\[cfg\([^\]]*\btest\b[^\]]*\)\]")
    at = 0
    while match := attribute.search(code, at):
        if "not(test" in match[0]:
            at = match.end()
            continue
        depth, end = 0, match.end()
        while end < len(code):
            sign = code[end]
            depth += (sign in "{([") - (sign in "})]")
            end += 1
            if depth == 0 and sign in ";}":
                break
        code = code[: match.start()] + blanked(code[match.start() : end], " ") + code[end:]
        at = match.start()
    return code


def rust_lines(text: str) -> int:
    return sum(bool(line.strip()) for line in without_tests(code_of(text)).split("\n"))


def python_lines(text: str) -> int:
    lines = {number for number, line in enumerate(text.split("\n"), 1) if line.strip() and not line.strip().startswith("#")}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            lines -= set(range(node.lineno, node.end_lineno + 1))
    return len(lines)


def sources(rev: str | None) -> dict[str, str]:
    """Text of every product source by its path."""
    listing = ["git", "ls-files", "-co", "--exclude-standard"] if rev is None else ["git", "ls-tree", "-r", "--name-only", rev]
    names = subprocess.run(listing, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    wanted = re.compile(r"crates/[^/]+/src/.*\.rs|crates/palpate-python/python/.*\.pyi?")
    # A file `tests.rs` stands under `#[cfg(test)] mod tests;`.
    names = sorted({name for name in names if wanted.fullmatch(name) and not name.endswith("/tests.rs")})
    if rev is None:
        return {name: (ROOT / name).read_text("utf-8") for name in names if (ROOT / name).exists()}
    requested = "".join(f"{rev}:{name}\n" for name in names).encode()
    stream = subprocess.run(["git", "cat-file", "--batch"], cwd=ROOT, check=True, capture_output=True, input=requested).stdout
    texts, at = {}, 0
    for name in names:
        head, at = stream[at : (end := stream.index(b"\n", at))], end + 1
        size = int(head.split()[2])
        texts[name], at = stream[at : at + size].decode(), at + size + 1
    return texts


def count(rev: str | None) -> Counter:
    lines = Counter()
    for name, text in sources(rev).items():
        crate = name.split("/")[1]
        lines[crate if name.endswith(".rs") else f"{crate} (Python)"] += (rust_lines if name.endswith(".rs") else python_lines)(text)
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rev", action="append", help="a commit to count; the first one is compared with the last")
    columns = {rev or "working tree": count(rev) for rev in parser.parse_args().rev or [None]}
    first, last = list(columns.values())[0], list(columns.values())[-1]
    crates = sorted({crate for column in columns.values() for crate in column})
    print("| crate | " + " | ".join(columns) + " | change |" if len(columns) > 1 else f"| crate | {' | '.join(columns)} |")
    print("|---" + "|---:" * (len(columns) + (len(columns) > 1)) + "|")
    for crate in [*crates, "all"]:
        value = (lambda column: column.total()) if crate == "all" else (lambda column, crate=crate: column[crate])
        row = [f"{value(column):,}" for column in columns.values()]
        if len(columns) > 1:
            row.append(f"{100 * (value(last) / value(first) - 1):+.1f} %" if value(first) else "new")
        print(f"| {crate} | " + " | ".join(row) + " |")


if __name__ == "__main__":
    main()
