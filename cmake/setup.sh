# Shared by ./run and ./test: installs what is missing and builds. Sourced with the project's root as the working folder.

# Installs the Debian packages named in the given lists, as far as they are missing.
install_missing() {
  local missing
  if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
    local tool absent=()
    for tool in g++ cmake ninja mpirun; do command -v "$tool" >/dev/null 2>&1 || absent+=("$tool"); done
    if [ ${#absent[@]} -gt 0 ]; then
      echo "thixis: this machine has no apt, and these programs are missing: ${absent[*]}. Install them and the libraries that correspond to the Debian packages of $* by hand, then try again." >&2
      exit 1
    fi
    return 0
  fi
  missing=$(cat "$@" | sed 's/#.*//' | while read -r package; do
    [ -n "$package" ] || continue
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || echo "$package"
  done)
  [ -n "$missing" ] || return 0
  local sudo=""
  if [ "$(id -u)" != 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
      echo "thixis: these Debian packages are missing, and neither root nor sudo is at hand to install them:" $missing >&2
      exit 1
    fi
    sudo=sudo
  fi
  echo "thixis: installing $(echo "$missing" | wc -l) missing packages" >&2
  {
    $sudo apt-get update -qq &&
      $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing
  } >apt.log 2>&1 || {
    echo "thixis: apt could not install:" $missing >&2
    tail -n 5 apt.log >&2
    rm -f apt.log
    exit 1
  }
  rm -f apt.log
}

# Configures (only when needed) and builds the given targets with preset `release`; further CMake settings in $THIXIS_CMAKE.
build() {
  local folder=build/release log=build/release/build.log
  mkdir -p "$folder"
  if [ ! -f "$folder/build.ninja" ] || [ -n "${THIXIS_CMAKE:-}" ]; then
    cmake --preset release ${THIXIS_CMAKE:-} >"$folder/configure.log" 2>&1 || {
      tail -n 20 "$folder/configure.log" >&2
      echo "thixis: the configuration failed; the whole output is in $folder/configure.log." >&2
      exit 1
    }
  fi
  if [ -n "$(ninja -C "$folder" -n "$@" 2>/dev/null | grep -v 'no work to do' | grep '^\[')" ]; then
    echo "thixis: building (the first time takes some minutes)" >&2
  fi
  ninja -C "$folder" "$@" >"$log" 2>&1 || {
    grep -E 'error|FAILED' "$log" | head -n 20 >&2
    echo "thixis: the build failed; the whole output is in $log." >&2
    exit 1
  }
}

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
