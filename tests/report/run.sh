#!/usr/bin/env bash
# The report in a browser:  tests/report/run.sh SCREE_COMMAND BUILD_FOLDER     77: skipped, for the reason it prints
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scree=$1 build=$2
browser=$(command -v chromium || command -v chromium-browser || true)
for what in "node:$(command -v node || true)" "npm:$(command -v npm || true)" "chromium:$browser"; do
  if [ -z "${what#*:}" ]; then
    echo "SKIPPED: ${what%%:*} is not installed, so the report was not opened in a browser (tests/run installs it)"
    exit 77
  fi
done

mkdir -p "$build"
if ! cmp -s "$here/package-lock.json" "$build/installed"; then
  cp "$here/package.json" "$here/package-lock.json" "$build/"
  if ! npm ci --prefix "$build" --ignore-scripts --no-audit --no-fund --loglevel=error; then
    echo "SKIPPED: npm could not install the browser's driver, so the report was not opened in a browser"
    exit 77
  fi
  cp "$here/package-lock.json" "$build/installed"
fi
export SCREE_COMMAND=$scree SCREE_BROWSER=$browser SCREE_MODULES=$build
node --test "$here/report_test.mjs"
exec node --test "$here/lattice_test.mjs"
