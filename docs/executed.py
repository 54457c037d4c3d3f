"""Notebooks as pages: each is run in a kernel of its own, and its page has what it prints and draws."""

from __future__ import annotations

import asyncio
import base64
from pathlib import Path
from typing import Any

import nbformat
from markdown.extensions.toc import slugify
from nbclient import NotebookClient

#: A page below this folder is that of a notebook.
FOLDER = "notebooks"

#: Contents by path in the site's sources: Markdown as text, figures as bytes.
Files = dict[str, str | bytes]

# Kernels warn of sockets without encryption, which these are: nothing leaves the machine.
_QUIET = ["--log-level=ERROR"]


def pages(folder: Path) -> Files:
    """The pages and figures of all notebooks in a folder; a cell that fails is an error."""
    found: Files = {}
    for notebook in asyncio.run(_run(sorted(folder.glob("*.ipynb")))):
        found |= _page(*notebook)
    return found


async def _run(paths: list[Path]) -> list[tuple[str, Any]]:
    async def one(path: Path) -> tuple[str, Any]:
        notebook = nbformat.read(path, as_version=4)
        client = NotebookClient(notebook, timeout=300, extra_arguments=_QUIET, resources={"metadata": {"path": str(path.parent)}})
        return path.stem, await client.async_execute()

    return await asyncio.gather(*map(one, paths))


def _page(name: str, notebook: Any) -> Files:
    figures: Files = {}
    parts: list[str] = []
    cards: list[str] = []
    heading = ""
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            parts.append(cell.source)
            heading = next((line for line in cell.source.splitlines() if line.startswith("#")), heading)
            continue
        parts.append(_fenced("python", cell.source))
        for output in cell.outputs:
            data = output.get("data", {})
            if "image/png" in data:
                path = f"{name}/figure-{len(figures) + 1}.png"
                figures[f"{FOLDER}/{path}"] = base64.b64decode(data["image/png"])
                title = heading.lstrip("# ")
                parts.append(f"![{title}]({path})")
                cards.append(f"[![]({path}) {title}](#{slugify(title, '-')})")
            elif "text/html" in data:
                parts.append(f'<div class="output">{data["text/html"]}</div>')
            else:
                parts.append(_fenced("text", output.get("text") or data["text/plain"]))
    if name == "gallery":
        # Under the introduction.
        parts.insert(1, '<div class="gallery" markdown>\n\n' + "\n\n".join(cards) + "\n\n</div>")
    return {f"{FOLDER}/{name}.md": "\n\n".join(parts) + "\n", **figures}


def _fenced(language: str, text: str) -> str:
    return f"```{language}\n{text.rstrip()}\n```"
