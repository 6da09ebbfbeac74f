"""The notebook of the documentation runs, and its results are pages and tables in it."""

from pathlib import Path

import nbclient
import nbformat

NOTEBOOK = Path(__file__).parents[3] / "docs" / "examples" / "notebook.ipynb"


def test_the_notebook_runs_and_shows_its_results():
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "kept without outputs"
    nbclient.NotebookClient(notebook, resources={"metadata": {"path": str(NOTEBOOK.parent)}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    pages = [output.data["text/html"] for output in outputs if "text/html" in output.get("data", {})]
    evaluated, batch, fleet = pages
    # The frame is closed to scripts, and what stands in it is a whole page with plots.
    for page in [evaluated, fleet]:
        assert page.startswith("<iframe") and "sandbox" in page and "&lt;svg" in page
    assert batch.count("<tr>") == 4 and "<td style=\"text-align:left\">few_degrees_of_freedom</td>" in batch
    printed = "".join(output.get("text", "") for output in outputs)
    assert "I = (9.9995 ± 0.0023) mA" in printed and "扩展不确定度" in printed
    assert "help: did you mean `half_width`?" in printed
