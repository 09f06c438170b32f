#!/bin/bash
# What a public project needs besides its code: licences as REUSE asks for them, a valid citation,
# well-formed workflows and templates, a site without broken links, and a software bill of materials; and
# that figures which are measured again stand on their page.
# Installs what is missing of packaging/packages/home.txt and of the lists that this names; takes about half
# a minute.
set -euo pipefail
cd "$(dirname "$0")/../.."

fail() {
  echo "home.sh: $*" >&2
  exit 1
}

./dev packages packaging/packages/build.txt packaging/packages/{docs,python,home}.txt

reuse lint | tail -n 1
reuse lint --quiet || fail "reuse lint says which files have no licence"
cmp LICENSE LICENSES/BSD-3-Clause.txt || fail "the two copies of the project's licence differ"
diff <(tail -n +3 lib/shapespace/output/fonts/LICENSE) LICENSES/LicenseRef-DejaVu.txt ||
  fail "the two copies of the font's licence differ"

benchmarks/all --page >/dev/null || fail "docs/measurements.md lacks what benchmarks/figures.toml names"
tests/docs/citation.py || fail "CITATION.cff is not valid"
yamllint --strict .github docs/mkdocs.yml CITATION.cff || fail "yamllint found the above"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
packaging/site.sh "$work/site" >"$work/site.log" || fail "the site: $(tail -n 20 "$work/site.log")"
tail -n 1 "$work/site.log"

# What comes before the tests in the list of packages is in programs or libraries.
for package in $(sed -n '/^# The tests/q; s/^\([a-z0-9.-]*-dev\).*/\1/p' packaging/packages/build.txt); do
  grep -qF "debian = \"$package\"" packaging/components.toml ||
    fail "packaging/components.toml has nothing about $package"
done
packaging/sbom.py "$work/materials"
tests/packages/materials.py "$work"/materials/*.spdx.json
echo "home.sh: passed"
