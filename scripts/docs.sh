#!/bin/sh
# Makes the API reference, docs/api/html/index.html; any warning of Doxygen is an error.
set -eu
cd "$(dirname "$0")/.."
scripts/setup.sh docs
mkdir -p docs/api
version=$(sed -n 's/^project(sinew VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
(cat docs/Doxyfile && echo "PROJECT_NUMBER = $version") | doxygen -
echo "docs: docs/api/html/index.html"
