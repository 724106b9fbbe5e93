#!/bin/sh
# Runs a compiler and keeps what it says in a file beside the object; shows it on failure.
object=
previous=
for argument in "$@"; do
    [ "$previous" != -o ] || object=$argument
    previous=$argument
done
[ -n "$object" ] || exec "$@"
if "$@" 2>"$object.figures"; then
    exit 0
fi
status=$?
cat "$object.figures" >&2
exit "$status"
