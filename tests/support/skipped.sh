# SPDX-License-Identifier: MIT
#
# usage: sh skipped.sh WHAT REASON
#
# A test that cannot run: ctest counts it as skipped (status 77), or as failed where ABUT_REQUIRE names WHAT.
case " ${ABUT_REQUIRE:-} " in
    *" $1 "*) printf 'ABUT_REQUIRE asks for a %s: %s\n' "$1" "$2"; exit 1 ;;
esac
printf 'abut skips: %s\n' "$2"
exit 77
