#!/usr/bin/python3
"""What a release consists of besides shapespace itself:

    packaging/sbom.py FOLDER

writes into FOLDER a bill of materials, shapespace-X.Y.Z.spdx.json (SPDX 2.3), and the notices of all
that it names, shapespace-X.Y.Z-third-party.txt. Versions are those of the Debian packages of this
system. Wheels and tools have a folder `licenses`, with a file for each library that is
linked into them; those in FOLDER are looked into. What packaging/components.toml does not know is an
error.
"""

import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tarfile
import time
import tomllib
import zipfile

PROJECT = pathlib.Path(__file__).resolve().parent.parent
EXTRACTED = {
    "LicenseRef-DejaVu": (PROJECT / "LICENSES/LicenseRef-DejaVu.txt").read_text(encoding="utf-8"),
    "LicenseRef-public-domain": "Its authors have put it into the public domain.\n",
}


def run(*command):
    done = subprocess.run(command, cwd=PROJECT, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"sbom.py: {' '.join(command)}: {done.stderr.strip()}")
    return done.stdout.strip()


def shapespace_version():
    text = (PROJECT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(ShapeSpace VERSION ([0-9.]+)", text)[1]


def version_of(component):
    if "version" in component:
        return component["version"]
    if "npm" in component:
        text = (PROJECT / "tools/viewer/package-lock.json").read_text(encoding="utf-8")
        return json.loads(text)["packages"]["node_modules/" + component["npm"]]["version"]
    return run("dpkg-query", "-W", "-f", "${source:Version}", component["debian"])


def address_of(name, component, version):
    """The package URL, https://github.com/package-url/purl-spec."""
    if "debian" in component:
        return f"pkg:deb/debian/{name}@{version.replace(':', '%3A')}?arch=source"
    kind = "npm" if "npm" in component else "generic"
    return f"pkg:{kind}/{name}@{version}"


def spdx_id(name):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)


def package(name, version, license, home, **more):
    return {
        "SPDXID": spdx_id(name),
        "name": name,
        "versionInfo": version,
        "downloadLocation": "NOASSERTION",
        "homepage": home,
        "filesAnalyzed": False,
        "licenseConcluded": "NOASSERTION",
        "licenseDeclared": license,
        "copyrightText": "NOASSERTION",
    } | more


def component_package(name, component):
    version = version_of(component)
    address = {
        "referenceCategory": "PACKAGE-MANAGER",
        "referenceType": "purl",
        "referenceLocator": address_of(name, component, version),
    }
    supplier = "Organization: Debian" if "debian" in component else "NOASSERTION"
    return package(name, version, component["license"], component["home"],
                   supplier=supplier, externalRefs=[address])


def names_in(archive):
    if archive.suffix == ".whl":
        return zipfile.ZipFile(archive).namelist()
    return tarfile.open(archive).getnames()


def libraries_in(archive, components):
    """The components that an archive contains: those whose licences it has."""
    paths = [pathlib.PurePosixPath(name) for name in names_in(archive)]
    found = {path.name for path in paths if path.parent.name == "licenses"} - {"LICENSE", "NOTICES"}
    unknown = found - set(components)
    unknown |= {path.name for path in paths if re.match(r"lib.*\.so", path.name)}
    if unknown:
        sys.exit(f"sbom.py: {archive.name} has {', '.join(sorted(unknown))} inside, which "
                 "packaging/components.toml does not know")
    return sorted(found)


def relation(one, kind, other):
    return {"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other}


def document(folder, version, components):
    whole = spdx_id("shapespace")
    home = "NOASSERTION"
    packages = [package("shapespace", version, "BSD-3-Clause", home)]
    relations = [relation("SPDXRef-DOCUMENT", "DESCRIBES", whole)]
    for name, component in components.items():
        packages.append(component_package(name, component))
        kind = "CONTAINS" if component["how"] == "contained" else "DYNAMIC_LINK"
        relations.append(relation(whole, kind, spdx_id(name)))
    for archive in sorted(folder.glob("*.whl")) + sorted(folder.glob("*-linux-*.tar.xz")):
        digest = hashlib.sha256(archive.read_bytes()).hexdigest()
        packages.append(package(
            archive.name, version, "NOASSERTION", home, packageFileName=archive.name,
            checksums=[{"algorithm": "SHA256", "checksumValue": digest}]))
        relations.append(relation("SPDXRef-DOCUMENT", "DESCRIBES", spdx_id(archive.name)))
        for name in libraries_in(archive, components):
            relations.append(relation(spdx_id(archive.name), "CONTAINS", spdx_id(name)))
    commit = run("git", "rev-parse", "HEAD")
    created = time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH") or
                              run("git", "log", "-1", "--format=%ct")))
    return {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"shapespace-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/shapespace-{version}-{commit}",
        "creationInfo": {
            "created": time.strftime("%Y-%m-%dT%H:%M:%SZ", created),
            "creators": ["Tool: shapespace-sbom", "Organization: The shapespace authors"],
        },
        "packages": packages,
        "relationships": relations,
        "hasExtractedLicensingInfos": [
            {"licenseId": name, "extractedText": text} for name, text in EXTRACTED.items()],
    }


def notices(components):
    parts = [(PROJECT / "NOTICES").read_text(encoding="utf-8")]
    for name, component in components.items():
        if "debian" in component:
            file = pathlib.Path("/usr/share/doc", component["debian"], "copyright")
            if not file.is_file():
                sys.exit(f"sbom.py: {file} is missing; install {component['debian']}")
            parts.append(f"{name}, as Debian's {component['debian']} says:\n\n"
                         + file.read_text(encoding="utf-8"))
    return ("\n\n" + "=" * 80 + "\n").join(parts)


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    version = shapespace_version()
    text = (PROJECT / "packaging/components.toml").read_text(encoding="utf-8")
    components = tomllib.loads(text)
    materials = document(folder, version, components)
    (folder / f"shapespace-{version}.spdx.json").write_text(
        json.dumps(materials, indent=1) + "\n", encoding="utf-8")
    (folder / f"shapespace-{version}-third-party.txt").write_text(
        notices(components), encoding="utf-8")


if __name__ == "__main__":
    main()
