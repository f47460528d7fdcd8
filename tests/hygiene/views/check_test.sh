#!/usr/bin/env bash
# check_test.sh CHECK BUILD PLANTED     the check finds the lines of PLANTED that say so, and no other ones
set -euo pipefail
command -v clang-query-14 >/dev/null || { echo "skipped: there is no clang-query"; exit 77; }
found=$("$1" "$2" "$3" || true)
lines=$(grep -oE 'planted\.cpp:[0-9]+' <<<"$found" | cut -d: -f2 | sort -nu)
wanted=$(grep -n '// found$' "$3" | cut -d: -f1)
[ "$lines" = "$wanted" ] || { echo "found:"; echo "$found"; echo "wanted, lines:" $wanted; exit 1; }
