#!/bin/bash
# The documents and the reference as a site, which can be read from the folder or put on a server:
#   packaging/site.sh FOLDER
# Fails if a link within it is broken.
set -euo pipefail
. "$(dirname "$0")/release_common.sh"
out=$(out_folder "${1:-}")
cd "$project"
command -v mkdocs >/dev/null ||
  die "mkdocs is missing. As root: apt-get install mkdocs mkdocs-material"

./dev docs
packaging/site_pages.py build/site-pages
cp -r build/docs/html build/site-pages/reference
# Debian 12's doxygen lists the nested classes of a class that has private ones only, and has no such
# list.
grep -lr --include='class*.html' 'href="#nested-classes"' build/site-pages/reference |
  xargs grep -L 'name="nested-classes"' |
  xargs --no-run-if-empty sed -i '/href="#nested-classes"/d'
mkdocs build --config-file docs/mkdocs.yml --quiet --strict --site-dir "$out"
rm -f "$out"/sitemap.xml*  # of no use without an address
tests/docs/links.py "$out"
if grep -rlF "$project" "$out"; then die "the pages above name the folder of the build"; fi
