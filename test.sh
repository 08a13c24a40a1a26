#!/usr/bin/env bash
# ./test.sh [arguments of ctest]: installs what is missing and runs all tests, under address and undefined sanitizers.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 3
. ./setup.sh
install_packages build test || exit $?
build sanitize || exit $?
say "Testing ..."
ctest --preset sanitize "$@"
