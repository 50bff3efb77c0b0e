#!/bin/sh
# Makes the API reference, docs/api/html/index.html; any warning of Doxygen is an error.
#   scripts/docs.sh [FOLDER]     where it is written: docs/api
set -eu
cd "$(dirname "$0")/.."
folder=${1:-docs/api}
scripts/setup.sh docs
mkdir -p "$folder"
version=$(sed -n 's/^project(sinew VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
(cat docs/Doxyfile && echo "PROJECT_NUMBER = $version" && echo "OUTPUT_DIRECTORY = $folder") | doxygen -
echo "docs: $folder/html/index.html"
