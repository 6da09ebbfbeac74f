"""Calculates the formulas of workbooks with the package `formulas` and holds them against the values that stand in
the cells. Exit code 77 where the packages are not there."""

import os
import sys
import warnings

warnings.simplefilter("ignore")
try:
    import formulas
    import openpyxl
except ImportError:
    sys.exit(77)

# Slopes are differences over u/100; no printed figure shows less.
TOLERANCE = 1e-5

wrong = 0
for path in sys.argv[1:]:
    held, written = (openpyxl.load_workbook(path, data_only=only) for only in (True, False))
    found = formulas.ExcelModel().loads(path).finish().calculate()
    book, checked = os.path.basename(path), 0
    for sheet in written:
        # What is small beside the largest number of its column is nothing.
        for column in sheet.iter_cols():
            cells = [cell for cell in column if isinstance(cell.value, str) and cell.value.startswith("=")]
            values = [held[sheet.title][cell.coordinate].value for cell in cells]
            largest = max((abs(v) for v in values if isinstance(v, (int, float))), default=0)
            for cell, expected in zip(cells, values):
                key = f"'[{book}]{sheet.title.upper()}'!{cell.coordinate}"
                value = found[key].value[0, 0]
                checked += 1
                if isinstance(expected, str) or isinstance(value, str):
                    same = str(expected) == str(value)
                else:
                    same = abs(value - expected) <= TOLERANCE * max(abs(expected), 1e-3 * largest)
                if not same:
                    wrong += 1
                    print(f"{book} {sheet.title} {cell.coordinate} {cell.value}: {expected!r} is {value!r}")
    print(f"{book}: {checked} formulas")
    wrong += checked == 0
sys.exit(wrong > 0)
