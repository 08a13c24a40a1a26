#!/usr/bin/env bash
# ./run.sh [arguments]: installs what is missing, builds, and runs fieldproof with the arguments.
# Without any: the whole suite against the embedded emulator.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
caller=$PWD
cd "$here" || exit 3
. ./setup.sh
install_packages build || exit $?
build tool || exit $?
cd "$caller" || exit 3
if [ $# -eq 0 ]; then set -- run; fi
exec "$here/build/tool/fieldproof" "$@"
