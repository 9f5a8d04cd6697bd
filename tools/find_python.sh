#!/bin/sh
# Prints the path of a Python 3.12 or newer that can make virtual environments.
# Otherwise says in one line what to install, and fails. PYTHON=/path/to/python overrules the search.
set -u

candidates() {
    if [ -n "${PYTHON:-}" ]; then
        echo "$PYTHON"
        return
    fi
    for name in python3.12 python3.13 python3.14 python3 python; do
        command -v "$name"
    done
    for python in "${PYENV_ROOT:-${HOME:-}/.pyenv}"/versions/3.*/bin/python3; do
        [ -x "$python" ] && echo "$python"
    done
    command -v uv >/dev/null && uv python find --no-project '>=3.12' 2>/dev/null
}

without_venv=
while IFS= read -r python; do
    # A pyenv shim is on PATH even when its version is not selected: ask, do not trust the name.
    executable=$("$python" -c 'import sys
if sys.version_info < (3, 12): sys.exit(1)
print(sys.executable)' 2>/dev/null) || continue
    if "$executable" -c 'import ensurepip, venv' 2>/dev/null; then
        echo "$executable"
        exit 0
    fi
    without_venv=$executable
done <<EOF
$(candidates)
EOF

if [ -n "$without_venv" ]; then
    version=$("$without_venv" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    echo "humanwalk: $without_venv lacks venv; install it: apt-get install python$version-venv" >&2
elif [ -n "${PYTHON:-}" ]; then
    echo "humanwalk: PYTHON=$PYTHON is not Python 3.12 or newer; name one that is, or leave PYTHON unset" >&2
else
    echo "humanwalk: no Python 3.12 or newer found; install one: pyenv install 3.12, or uv python install 3.12, or your system's python3.12 and python3.12-venv" >&2
fi
exit 1
