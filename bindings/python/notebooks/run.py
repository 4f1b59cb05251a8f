#!/usr/bin/env python3
"""run.py NOTEBOOK: runs all cells in one program and compares the text that they print with what is in the file; pictures, which depend
on fonts, have to be as many. With --write it puts what came out into the file. It needs matplotlib and nothing of Jupyter, whose own
programs take a notebook of this form as well."""

import ast
import base64
import contextlib
import io
import json
import os
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def run(source: str, names: dict) -> list:
    """The outputs of a cell: what it prints, the value of its last line, and its figures."""
    tree, said, value = ast.parse(source), io.StringIO(), None
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    with contextlib.redirect_stdout(said):
        exec(compile(tree, "cell", "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    outputs = []
    if said.getvalue():
        outputs.append({"name": "stdout", "output_type": "stream", "text": said.getvalue().splitlines(keepends=True)})
    if value is not None:
        text = {"text/plain": repr(value).splitlines(keepends=True)}
        outputs.append({"data": text, "execution_count": None, "metadata": {}, "output_type": "execute_result"})
    for number in plt.get_fignums():
        picture = io.BytesIO()
        plt.figure(number).savefig(picture, format="png", dpi=80, bbox_inches="tight", metadata={"Software": None})
        data = {"image/png": base64.b64encode(picture.getvalue()).decode() + "\n"}
        outputs.append({"data": data, "metadata": {}, "output_type": "display_data"})
    plt.close("all")
    return outputs


def text(outputs: list) -> list:
    """What is compared."""
    return ["picture" if "image/png" in output.get("data", {}) else output.get("text") or output["data"]["text/plain"] for output in outputs]


def main() -> None:
    path = Path(sys.argv[1]).resolve()
    notebook = json.loads(path.read_text())
    os.chdir(path.parent)
    names: dict = {"__name__": "__main__"}
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    pictures = 0
    for number, cell in enumerate(cells, 1):
        outputs = run("".join(cell["source"]), names)
        for output in outputs:
            if "execution_count" in output:
                output["execution_count"] = number
        if "--write" not in sys.argv and text(outputs) != text(cell["outputs"]):
            sys.exit(f"{path.name}, cell {number}: in the file\n{text(cell['outputs'])}\nbut it gives\n{text(outputs)}")
        pictures += text(outputs).count("picture")
        cell.update(execution_count=number, outputs=outputs)
    if "--write" in sys.argv:
        path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n")
    print(f"{path.name}: {len(cells)} cells, {pictures} pictures")


main()
