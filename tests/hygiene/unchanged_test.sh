#!/usr/bin/env bash
# unchanged_test.sh UNCHANGED FOLDER     what the watch over the source tree lets pass and what it does not
set -euo pipefail
unchanged=$1
rm -rf "$2"
mkdir -p "$2"
cd "$2"
expect() { # CODE COMMAND...
  local wanted=$1 code=0
  shift
  "$unchanged" "$@" 2>words || code=$?
  [ "$code" = "$wanted" ] || { echo "exit code $code, not $wanted, of: $*"; cat words; exit 1; }
}
command -v git >/dev/null || { echo "skipped: there is no git"; exit 77; }
export GIT_CEILING_DIRECTORIES=$PWD/..
mkdir plain
cd plain
expect 0 true
expect 3 sh -c "echo x > left; exit 3"
grep -q "no git tree" words
mkdir ../tree
cd ../tree
git init -q .
echo words > .gitignore
echo a > kept
git add .gitignore kept
git -c user.name=x -c user.email=x commit -qm x
echo b > kept   # a tree under work is as good as a clean one
expect 0 true
expect 4 sh -c "exit 4"
expect 1 sh -c "echo x > left"
grep -q "left" words
expect 0 true
expect 1 sh -c "echo y >> kept"
expect 1 rm left
expect 5 sh -c "echo x > again; exit 5"
