# Shared by ./run and ./test: installs what is missing and builds. Sourced with the project's root as the working folder.

fail() {
  echo "thixis: $*" >&2
  exit 1
}

# Without apt nothing can be installed: says which programs must be.
need_programs() {
  local tool absent=()
  for tool in "${CXX:-g++}" cmake ninja mpirun; do command -v "$tool" >/dev/null 2>&1 || absent+=("$tool"); done
  [ ${#absent[@]} -eq 0 ] || fail "this machine has no apt, and these programs are missing: ${absent[*]}. Install them, and the" \
    "libraries that correspond to the Debian packages of $*, by hand; then try again."
}

# Installs the Debian packages named in the given lists, as far as they are missing.
install_missing() {
  if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
    need_programs "$@"
    return 0
  fi
  local wanted installed package missing="" sudo=() log=build/apt.log
  wanted=$(sed 's/#.*//' "$@")
  installed=" $(dpkg-query -W -f='${db:Status-Status}=${Package} ' $wanted 2>/dev/null || true)"
  for package in $wanted; do
    [[ "$installed" == *" installed=$package "* ]] || missing+="$package "
  done
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null 2>&1 || fail "Debian packages are missing, and neither root nor sudo is at hand. Have" \
      "somebody run: apt-get install --no-install-recommends $missing"
    sudo=(sudo)
  fi
  echo "thixis: installing $(echo $missing | wc -w) missing Debian packages and what they need" >&2
  mkdir -p build
  {
    "${sudo[@]}" apt-get update -qq || echo "apt-get update failed; the lists at hand must do."
    "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing
  } >"$log" 2>&1 </dev/null || {
    grep -E '^[EW]: ' "$log" | head -n 5 >&2 || tail -n 5 "$log" >&2
    fail "apt could not install the Debian packages that are missing; the whole output is in $log."
  }
}

# configured_with PRESET [-DNAME=VALUE...]: whether its build folder is configured with all of these settings.
configured_with() {
  local folder=build/$1 setting
  shift
  [ -f "$folder/build.ninja" ] || return 1
  for setting in "$@"; do
    sed 's/^/-D/; s/:[A-Z]*=/=/' "$folder/CMakeCache.txt" | grep -xF -e "$setting" >/dev/null || return 1
  done
}

# configure PRESET [-DNAME=VALUE...]: with these settings and those in $THIXIS_CMAKE, unless that is how it is configured.
configure() {
  local preset=$1 log=build/$1/configure.log
  shift
  configured_with "$preset" "$@" ${THIXIS_CMAKE:-} && return 0
  mkdir -p "build/$preset"
  cmake --preset "$preset" "$@" ${THIXIS_CMAKE:-} >"$log" 2>&1 </dev/null || {
    grep -A 5 'CMake Error' "$log" | head -n 20 >&2
    fail "the configuration failed; the whole output is in $log."
  }
}

# build PRESET TARGET...: builds them, and says so if there is more to do than to look at the version.
build() {
  local folder=build/$1 log=build/$1/build.log
  shift
  ninja -C "$folder" "$@" 2>&1 </dev/null | {
    files=0
    while IFS= read -r line; do
      echo "$line"
      if [[ "$line" == *"Building CXX"* ]] && [ $((++files)) -eq 2 ]; then
        echo "thixis: building (the first time takes some minutes)" >&2
      fi
    done >"$log"
  } || {
    grep -E 'error:|FAILED|CMake Error|undefined reference|cannot find' "$log" | head -n 20 >&2
    fail "the build failed; the whole output is in $log."
  }
}

# sources [N]: all of them, or those that the last N commits touched and that are still there.
sources() {
  if [ -z "${1:-}" ]; then
    find "$PWD/packages" "$PWD/apps" -name '*.cpp'
    return
  fi
  git log "-$1" --no-merges --name-only --format= --diff-filter=d -- 'packages/*.cpp' 'apps/*.cpp' | sort -u |
    while read -r file; do [ ! -f "$file" ] || echo "$PWD/$file"; done
}

# tidy PRESET [N]: clang-tidy on these sources. Its warnings are errors.
tidy() {
  local folder=build/$1 files
  files=$(sources "${2:-}")
  [ -n "$files" ] || return 0
  echo "thixis: clang-tidy on $(wc -w <<<"$files") files" >&2
  xargs -n 1 -P "$(nproc)" clang-tidy-14 -quiet -warnings-as-errors='*' -p "$folder" <<<"$files" 2>"$folder/tidy.log" ||
    fail "clang-tidy found mistakes; $folder/tidy.log has what else it said."
}

# views PRESET [N]: who touches elements of Kokkos Views, in these sources of the packages in tests/hygiene/views/packages.
views() {
  local folder=build/$1 packages files
  packages=$(sed 's/#.*//' tests/hygiene/views/packages | xargs | tr ' ' '|')
  files=$(sources "${2:-}" | grep -E "/packages/($packages)/" || true)
  [ -n "$files" ] || return 0
  echo "thixis: clang-query on $(wc -w <<<"$files") files" >&2
  tests/hygiene/views/check "$folder" $files || fail "the host must not touch elements of Views but through a mirror (CONTRIBUTING.md)."
}

# As root, on more ranks than cores, inside containers: all this is allowed.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_hwloc_base_binding_policy=none
