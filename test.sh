#!/usr/bin/env bash
# ./test.sh: installs what is missing and runs all tests, once plain and once under address and undefined sanitizers.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 3
. ./setup.sh
install_packages build test || exit $?
status=0
for preset in plain sanitize; do
  build "$preset" || exit $?
  say "Testing $preset ..."
  ctest --preset "$preset" || status=1
done
exit $status
