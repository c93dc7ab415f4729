#!/bin/sh
# Check, before anything is downloaded, that this machine can build and run softdepth.
# usage: scripts/preflight.sh PYTHON
set -eu
python=${1:-python3}
remedy="on Debian or Ubuntu: sudo apt-get install -y python3 python3-venv libpython3-dev g++ make perl"

fail() {
    echo "error: $1; $2" >&2
    exit 1
}

missing=""
for tool in "$python" g++ make perl; do
    command -v "$tool" >/dev/null 2>&1 || missing="$missing $tool"
done
[ -z "$missing" ] || fail "not found:$missing" "$remedy"

"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
    fail "$python is $("$python" -V 2>&1), and softdepth needs Python 3.11 or newer" \
        "name a newer one: make PYTHON=python3.12"

"$python" -c 'import ensurepip, venv' 2>/dev/null || fail "$python cannot make virtual environments" "$remedy"

# cocotb runs Python inside the simulator, which takes the shared library of this very interpreter.
"$python" - 2>/dev/null <<'PY' || fail "$python has no shared library (libpython)" "$remedy"
import ctypes, pathlib, sys, sysconfig

name = sysconfig.get_config_var("INSTSONAME") or ""
beside = pathlib.Path(sys.base_prefix, "lib", name)
ctypes.CDLL(str(beside) if name and beside.is_file() else name or "libpython.so")
PY
