#!/bin/sh
# Make a virtual environment from requirements.lock, every file checked against its hash.
# usage: scripts/venv.sh FOLDER PYTHON
set -eu
venv=$1
"${2:-python3}" -m venv --clear "$venv"
bin=$venv/bin

# uv is fast, but it reads the settings of pip neither from files nor from PIP_*: hand over the
# index, proxy and certificate. pip itself stays the fallback and honours all of them.
setting() { "$bin/pip" config get "global.$1" 2>/dev/null || true; }
hand_over() { # uv's variable, pip's value
    eval "now=\${$1:-}"
    [ -n "$now" ] || [ -z "$2" ] || export "$1=$2"
}
hand_over UV_DEFAULT_INDEX "${PIP_INDEX_URL:-$(setting index-url)}"
hand_over ALL_PROXY "${PIP_PROXY:-$(setting proxy)}"
hand_over SSL_CERT_FILE "${PIP_CERT:-$(setting cert)}"
hand_over UV_SYSTEM_CERTS 1

awk '/^[^ ]/ { keep = /^uv==/ } keep' requirements.lock >"$venv/uv.lock"
if ! { "$bin/pip" install --quiet --disable-pip-version-check --require-hashes -r "$venv/uv.lock" &&
    "$bin/uv" pip install --quiet --python "$bin/python" --require-hashes -r requirements.lock; }; then
    echo "uv could not install requirements.lock; going on with pip, which takes longer" >&2
    "$bin/pip" install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
fi
