"""Reads digital calibration certificates with the package `pydcc`, which knows nothing of gumption.

usage: read.py CERTIFICATE...; ends with 77 where the package is not at hand.
Prints for each a line of JSON: number, laboratory, last day, and the quantities with what stands in them.
"""
import json
import sys
import types

# What checks signatures does not load beside current versions of OpenSSL; nothing is signed here.
unused = types.ModuleType("certvalidator")
unused.CertificateValidator = unused.errors = unused.ValidationContext = None
sys.modules.setdefault("certvalidator", unused)
try:
    from dcc import DCC, dcc
except ImportError:
    sys.exit(77)
# It would fetch the schemas first; ours are held against them elsewhere.
dcc.DCCXMLValidator = object

for file in sys.argv[1:]:
    read = DCC(file)
    if not read.is_loaded():
        sys.exit(f"{file} is not read")
    found = read.get_calibration_results("name", lang="en")
    print(json.dumps({
        "number": read.uid(),
        "laboratory": read.calibration_laboratory_name(),
        "date": str(read.calibration_date())[:10],
        "results": found,
    }))
