# Sourced by run.sh and test.sh: installs what is missing from packages.txt, and builds a preset.

say() { printf '%s\n' "$*" >&2; }

# release: the one of this system that packages.txt knows, else Debian 12.
release() {
  local here
  here=$(. "${OS_RELEASE:-/etc/os-release}" 2>/dev/null && echo "$ID-${VERSION_ID:-}")
  grep -qE "^[^#].* ${here:-none}( |$)" packages.txt && echo "$here" || echo debian-12
}

# packages_of KIND...: the packages of these kinds, of this release.
packages_of() {
  awk -v kinds=" $* " -v release=" $(release) " \
    '$1 !~ /^#/ && index(kinds, " " $1 " ") && (NF == 2 || index($0 " ", release)) { print $2 }' packages.txt
}

# install_packages KIND...: those that are not installed yet.
install_packages() {
  local wanted missing
  wanted=$(packages_of "$@")
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    say "This is not a Debian system. Install the equivalents of these packages, then run cmake --preset tool:"
    say "$wanted"
    return 2
  fi
  # One query for all; a package that dpkg has never heard of is missing, too.
  missing=$(comm -23 <(printf '%s\n' $wanted | sort) \
    <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' $wanted 2>/dev/null | awk '$1 == "installed" { print $2 }' | sort -u))
  [ -z "$missing" ] && return 0
  local sudo=""
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { say "Packages are missing, and neither root nor sudo is here. Install:"; say "$missing"; return 2; }
    sudo=sudo
  fi
  say "Installing:" $missing
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get update >&2 || { say "apt-get update failed; is the network up?"; return 2; }
  # --no-remove: a conflict with something that you use stops here instead of removing it.
  if ! $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-remove --no-install-recommends $missing >&2; then
    say "The packages could not be installed without removing others (see above). Resolve the conflict, then run this again."
    return 2
  fi
}

# compilers: how many at once; one a core, as far as there are 2.5 GB for each (a wing of the house takes 2).
compilers() {
  awk -v cores="$(nproc)" '/^MemAvailable/ { n = int($2 / 2500000) } END { print n < 1 ? 1 : n < cores ? n : cores }' /proc/meminfo
}

# progress LOG: what a build prints goes to LOG; on a terminal, how far it is stands in one line.
progress() {
  if [ -t 2 ]; then
    local line
    while IFS= read -r line; do
      printf '%s\n' "$line"
      [[ $line == \[* ]] && printf '\r\033[K%s]' "${line%%]*}" >&2
    done >"$1"
    printf '\r\033[K' >&2
  else
    cat >"$1"
  fi
}

# build PRESET: configures when needed and builds. Quiet unless it fails. Two presets never configure at once.
build() {
  local preset=$1 log="build/$1.log"
  mkdir -p build
  local launcher=()
  # Paths relative to this folder: another clone of the same tree hits the same cache.
  export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
  # Without these it takes no file that uses a precompiled header.
  export CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  # Its g++ is 11, and C++20 wants 12.
  if [ -z "${CXX:-}" ] && [ "$(release)" = ubuntu-22.04 ]; then export CXX=g++-12; fi
  if [ ! -f "build/$preset/build.ninja" ]; then
    say "Configuring $preset ..."
    cmake --preset "$preset" "${launcher[@]}" >"$log" 2>&1 || { cat "$log" >&2; return 3; }
  fi
  [ -x "build/$preset/fieldproof" ] || say "Building $preset (the first time takes minutes) ..."
  cmake --build --preset "$preset" --parallel "$(compilers)" 2>&1 | progress "$log"
  [ "${PIPESTATUS[0]}" = 0 ] || { grep -v '^\[' "$log" | tail -n 60 >&2; say "The build failed; all of it is in $log"; return 3; }
}
