#!/bin/sh
# Builds the documentation. Any warning of Doxygen or Sphinx and any broken link is an error.
#   scripts/docs.sh                  the site, build/docs/html/index.html: guides, scene reference, Python
#                                    and C++ reference; needs the built Python package
#   scripts/docs.sh --cpp [FOLDER]   only Doxygen's C++ reference, FOLDER/html/cpp (default build/docs)
set -eu
cd "$(dirname "$0")/.."
cpp_alone=no
if [ "${1:-}" = --cpp ]; then
  cpp_alone=yes
  shift
fi
folder=${1:-build/docs}
scripts/setup.sh docs

mkdir -p "$folder/html"
version=$(sed -n 's/^project(sinew VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
(cat docs/Doxyfile && echo "PROJECT_NUMBER = $version" && echo "OUTPUT_DIRECTORY = $folder/html" &&
  echo "GENERATE_TAGFILE = $folder/cpp.tag") | doxygen -
if [ "$cpp_alone" = yes ]; then
  echo "docs: $folder/html/cpp/index.html"
  exit 0
fi

# Sphinx reads the pages in a layout in which the links between them are valid, beside the pages generated from the code.
rm -rf "$folder/source"
find "$folder/html" -mindepth 1 -maxdepth 1 ! -name cpp -exec rm -rf {} +
mkdir -p "$folder/source"
for page in docs examples src README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE; do
  ln -s "$PWD/$page" "$folder/source/$page"
done
/usr/bin/python3 docs/site/reference.py "$folder/source/reference" "$folder/cpp.tag"
PYTHONPATH=build/release/python /usr/bin/python3 -m sphinx -q -E -a -W --keep-going -b html \
  -D "version=$version" -D "release=$version" -d "$folder/doctrees" -c docs/site "$folder/source" "$folder/html"
printf '<!doctype html><meta http-equiv="refresh" content="0; url=docs/index.html"><a href="docs/index.html">Sinew</a>\n' \
  >"$folder/html/index.html"
/usr/bin/python3 docs/site/check_links.py "$folder/html"
echo "docs: $folder/html/index.html"
