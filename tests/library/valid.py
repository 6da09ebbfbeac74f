"""Holds digital calibration certificates against the schema, and against what the schema does not check.

usage: valid.py SCHEMA CERTIFICATE...; ends with 77 where lxml or the schema is not at hand.
"""
import os
import re
import sys

try:
    from lxml import etree
except ImportError:
    sys.exit(77)

schema, files = sys.argv[1], sys.argv[2:]
if not os.path.exists(schema):
    sys.exit(77)
schema = etree.XMLSchema(etree.parse(schema))
SI = "{https://ptb.de/si}"
UNIT = re.compile(r"(\\[a-z]+(\\tothe\{-?[0-9.]+\})?)+$")
bad = 0


def fault(file, element, what):
    global bad
    bad += 1
    print(f"{file}:{element.sourceline}: {what}")


for file in files:
    tree = etree.parse(file)
    if not schema.validate(tree):
        for error in schema.error_log:
            bad += 1
            print(f"{file}:{error.line}: {error.message}")
    for element in tree.iter(SI + "unit", SI + "unitXMLList"):
        for word in element.text.split():
            if not UNIT.match(word):
                fault(file, element, f"no unit of the D-SI: {word}")
    for values in tree.iter(SI + "valueXMLList"):
        lengths = {len(one.text.split()) for one in values.getparent().iter() if one.tag.endswith("XMLList") and one.text and one.text.strip()
                   and "covariance" not in one.getparent().tag.lower() and "Region" not in one.getparent().tag}
        if len(lengths - {1}) > 1:
            fault(file, values, f"lists of different lengths: {lengths}")
    names = {code.text for code in tree.iter("{https://ptb.de/dcc}usedLangCodeISO639_1")}
    for content in tree.iter("{https://ptb.de/dcc}content"):
        if content.get("lang") not in names | {None}:
            fault(file, content, "a language that is not declared")
sys.exit(1 if bad else 0)
