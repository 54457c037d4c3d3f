#!/usr/bin/env python3
"""Docstrings of the compiled part of the Python package, copied into its stub, where editors read them.

    .ci/stub_docstrings.py           writes them, of the palpate that is installed
    .ci/stub_docstrings.py --check   fails where the stub has others

Types in the stub are written by hand; docstrings are not.
"""

from __future__ import annotations

import ast
import inspect
import re
import sys
from pathlib import Path

from palpate import _palpate

STUB = Path(__file__).resolve().parents[1] / "crates/palpate-python/python/palpate/_palpate.pyi"


def is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def without(stub: str) -> str:
    """The stub without docstrings, but for its own."""
    lines = stub.splitlines()
    tree = ast.parse(stub)
    bodies = [tree.body[1:], *(node.body for node in ast.walk(tree) if isinstance(node, (ast.ClassDef, ast.FunctionDef)))]
    for node in sorted((node for body in bodies for node in body if is_text(node)), key=lambda node: -node.lineno):
        assert node.end_lineno is not None
        del lines[node.lineno - 1 : node.end_lineno]
    # What is left of a body goes back behind its head.
    return re.sub(r":((?:  #[^\n]*)?)\n +\.\.\.\n", r": ...\1\n", "\n".join(lines) + "\n")


def runtime(tree: ast.Module, kind: ast.ClassDef) -> list[type]:
    """The class of this name, or those of the compiled part that a class of the stub alone stands for."""
    found = getattr(_palpate, kind.name, None)
    if found is not None:
        return [found]
    heirs = [node for node in tree.body if isinstance(node, ast.ClassDef) and kind.name in [ast.unparse(base) for base in node.bases]]
    return [one for heir in heirs for one in runtime(tree, heir)]


def docstring(owners: list[object], name: str) -> str | None:
    """The docstring of what is called so, if all have the same; methods of Python's own protocols need none."""
    if name.startswith("_"):
        return None
    entries = [vars(owner).get(name) if isinstance(owner, type) else getattr(owner, name, None) for owner in owners]
    texts = {inspect.getdoc(entry) for entry in entries if entry is not None}
    return texts.pop() if len(texts) == 1 else None


def quoted(text: str, indent: str) -> list[str]:
    text = text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    lines = [f"{indent}{line}".rstrip() for line in text.splitlines()]
    lines[0] = f'{indent}"""{text.splitlines()[0]}'
    if len(lines) == 1 and not text.endswith('"'):
        return [lines[0] + '"""']
    return [*lines, f'{indent}"""']


def with_docstrings(stub: str) -> str:
    """The stub with the docstrings of what is installed."""
    bare = without(stub)
    tree = ast.parse(bare)
    lines = bare.splitlines()

    def insert(node: ast.stmt, text: str, line: int, indent: str) -> None:
        head = lines[line - 1]
        opened = re.sub(r": \.\.\.((?:  #.*)?)$", r":\1", head)
        body = quoted(text, indent)
        lines[line - 1 : line] = [opened, *body, *([f"{indent}..."] if opened != head else [])]

    def described(body: list[ast.stmt], owners: list[object], indent: str) -> None:
        first = {name: node for node in reversed(body) if (name := named(node))}
        # Of several overloads the first has it. From the end on, so that lines keep their numbers.
        for name, node in sorted(first.items(), key=lambda one: -one[1].lineno):
            text = docstring(owners, name)
            if isinstance(node, ast.ClassDef):
                kinds: list[object] = list(runtime(tree, node))
                described(node.body, kinds, "    ")
                if text is not None:
                    insert(node, text, node.lineno, "    ")
            elif text is not None and node.end_lineno is not None:
                insert(node, text, node.end_lineno, f"{indent}    " if isinstance(node, ast.FunctionDef) else indent)

    described(tree.body[1:], [_palpate], "")
    return "\n".join(lines) + "\n"


def named(node: ast.stmt) -> str:
    """The name that a statement gives to something; none of an alias of types."""
    if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
        return node.name
    is_value = isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.value is None
    return node.target.id if is_value else ""


def main() -> None:
    stub = STUB.read_text(encoding="utf-8")
    made = with_docstrings(stub)
    if "--check" not in sys.argv[1:]:
        STUB.write_text(made, encoding="utf-8")
    elif made != stub:
        sys.exit(f"{STUB}: the docstrings are not those of the package that is installed\nhint: run .ci/stub_docstrings.py")


if __name__ == "__main__":
    main()
