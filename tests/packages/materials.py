#!/usr/bin/python3
"""Whether a bill of materials has what SPDX 2.3 asks for (https://spdx.github.io/spdx-spec/v2.3/):

    tests/packages/materials.py FILE.spdx.json

SPDX's own schema is in no package of Debian; this looks at the keys that the specification calls
mandatory, at identifiers and what they refer to, and at the licences, by the list in
python3-license-expression.
"""

import json
import pathlib
import re
import sys

from license_expression import get_spdx_licensing

PACKAGE = {"SPDXID", "name", "downloadLocation"}
DOCUMENT = {"spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo"}


def problems(document):
    for key in sorted(DOCUMENT - set(document)):
        yield f"{key} is missing"
    if document["spdxVersion"] != "SPDX-2.3" or document["dataLicense"] != "CC0-1.0":
        yield "it is not of SPDX 2.3, or under another licence than CC0-1.0"
    created = document["creationInfo"]["created"]
    if not re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", created):
        yield f"{created} is no time"
    for creator in document["creationInfo"]["creators"]:
        if not re.match(r"(Tool|Person|Organization): .", creator):
            yield f"{creator} is no creator"

    extracted = {entry["licenseId"] for entry in document["hasExtractedLicensingInfos"]}
    licensing = get_spdx_licensing()
    names = [document["SPDXID"]]
    for package in document["packages"]:
        label = package.get("name")
        for key in sorted(PACKAGE - set(package)):
            yield f"{label}: {key} is missing"
        names.append(package["SPDXID"])
        if not package.get("versionInfo"):
            yield f"{label} has no version"
        declared = package["licenseDeclared"]
        if declared == "NOASSERTION":
            continue
        for symbol in licensing.license_symbols(declared, decompose=True):
            known = symbol.key in (extracted if symbol.key.startswith("LicenseRef-")
                                   else licensing.known_symbols)
            if not known:
                yield f"{label}: {symbol.key} is no licence of SPDX's list"
    for name in names:
        if not re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", name) or names.count(name) > 1:
            yield f"{name} is no identifier, or of several packages"

    described = set()
    for entry in document["relationships"]:
        for end in (entry["spdxElementId"], entry["relatedSpdxElement"]):
            if end not in names:
                yield f"{end} is not in the document"
        described.add(entry["relatedSpdxElement"])
    for name in sorted(set(names[1:]) - described):
        yield f"nothing says what {name} is for"


def main():
    file = sys.argv[1]
    document = json.loads(pathlib.Path(file).read_text(encoding="utf-8"))
    found = list(problems(document))
    for problem in found:
        print(f"{file}: {problem}", file=sys.stderr)
    print(f"materials.py: {len(document['packages'])} packages, {len(found)} findings")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
