#!/usr/bin/env bash
# ./fuzz.sh MINUTES [TARGET...]: installs what is missing, builds the fuzzers and feeds each target for so many minutes, as
# many at once as there are cores (JOBS=1: one). A target stops at its first finding. What was new is kept in build/fuzz/corpus.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 3
. ./setup.sh

[[ ${1:-} =~ ^[0-9]+([.][0-9]+)?$ ]] || { say "usage: ./fuzz.sh MINUTES [TARGET...]"; exit 2; }
seconds=$(awk -v minutes="$1" 'BEGIN { print int(60 * minutes + 0.5) }')
shift
install_packages build fuzz || exit $?
build fuzz || exit $?

export here=build/fuzz
export ASAN_SYMBOLIZER_PATH=/usr/bin/llvm-symbolizer-16
mkdir -p $here/{corpus,findings,logs}
seeds=$($here/fieldproof_fuzz "$@" --write-seeds $here/seeds) || exit 2

# feed TARGET SECONDS
feed() {
  mkdir -p "$here/corpus/$1"
  FIELDPROOF_FUZZ_TARGET=$1 $here/fieldproof_libfuzzer -max_total_time="$2" -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$here/findings/$1-" "$here/corpus/$1" "$here/seeds/$1" >"$here/logs/$1" 2>&1
  echo $? >"$here/logs/$1.code"
}
export -f feed
say "Feeding $(wc -l <<<"$seeds") targets for $seconds s each ..."
awk '{ print $1 }' <<<"$seeds" | xargs -P "${JOBS:-$(nproc)}" -I{} bash -c "feed {} $seconds"

# of NAME TARGET: the last number that libFuzzer says of it.
of() { grep -aoE "$1:? +[0-9]+" "$here/logs/$2" | tail -n 1 | grep -oE '[0-9]+$' || echo 0; }
found=0 all=0
printf '%-11s %12s %9s  %s\n' target inputs edges finding
for target in $(awk '{ print $1 }' <<<"$seeds"); do
  inputs=$(of stat::number_of_executed_units "$target")
  all=$((all + inputs)) finding=none
  if [ "$(cat "$here/logs/$target.code")" != 0 ]; then
    found=1
    finding=$(grep -aoE "$here/findings/\S+" "$here/logs/$target" | tail -n 1)
    finding="${finding:-none kept}: FIELDPROOF_FUZZ_TARGET=$target $here/fieldproof_libfuzzer ${finding:-}; see $here/logs/$target"
  fi
  printf '%-11s %12d %9d  %s\n' "$target" "$inputs" "$(of cov "$target")" "$finding"
done
printf '%-11s %12d\n' all "$all"
exit $found
