"""Lets LibreOffice calculate workbooks and holds its figures against the values that stand in the cells.

usage: office.py FOLDER WORKBOOK...; ends with 77 where LibreOffice or openpyxl is not at hand.
"""

import os
import shutil
import subprocess
import sys
import warnings

warnings.simplefilter("ignore")
try:
    import openpyxl
except ImportError:
    sys.exit(77)
office = shutil.which("soffice") or shutil.which("libreoffice")
if office is None:
    sys.exit(77)

# Slopes are differences over u/100; no printed figure shows less.
TOLERANCE = 1e-5

folder, paths = sys.argv[1], sys.argv[2:]
bare, done = os.path.join(folder, "bare"), os.path.join(folder, "done")
for one in (bare, done):
    os.makedirs(one, exist_ok=True)
copies = []
for path in paths:
    # Written again without the values of its formulas, which have to be calculated then.
    copies.append(os.path.join(bare, os.path.basename(path)))
    openpyxl.load_workbook(path).save(copies[-1])
profile = "-env:UserInstallation=file://" + os.path.join(folder, "profile")
command = [office, profile, "--headless", "--convert-to", "xlsx", "--outdir", done, *copies]
subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=600)

wrong = 0
for path in paths:
    held, written = (openpyxl.load_workbook(path, data_only=only) for only in (True, False))
    found = openpyxl.load_workbook(os.path.join(done, os.path.basename(path)), data_only=True)
    book, checked = os.path.basename(path), 0
    for sheet in written:
        # What is small beside the largest number of its column is nothing.
        for column in sheet.iter_cols():
            cells = [cell for cell in column if isinstance(cell.value, str) and cell.value.startswith("=")]
            values = [held[sheet.title][cell.coordinate].value for cell in cells]
            largest = max((abs(v) for v in values if isinstance(v, (int, float))), default=0)
            for cell, expected in zip(cells, values):
                value = found[sheet.title][cell.coordinate].value
                checked += 1
                if isinstance(expected, (int, float)) and isinstance(value, (int, float)):
                    same = abs(value - expected) <= TOLERANCE * max(abs(expected), 1e-3 * largest)
                else:
                    same = str(expected) == str(value)
                if not same:
                    wrong += 1
                    print(f"{book} {sheet.title} {cell.coordinate} {cell.value}: {expected!r} is {value!r}")
    print(f"{book}: {checked} formulas")
    wrong += checked == 0
sys.exit(wrong > 0)
