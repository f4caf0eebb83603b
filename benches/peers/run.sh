#!/usr/bin/env bash
# Installs what the comparison needs, then runs main.py: arguments are passed on, see --help.
#
#   benches/peers/run.sh [--octave] [--rounds N] [--replicates N] [--check-only] [--out DIR]
#
# --octave also installs GNU Octave and its control package with apt-get (as root).
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
environment=$root/target/peers-venv

arguments=()
for argument in "$@"; do
    if [ "$argument" = --octave ]; then
        apt-get update -qq && apt-get install -y -qq --no-install-recommends octave octave-control >&2 \
            || echo "NOT AVAILABLE: apt-get could not install GNU Octave" >&2
    else
        arguments+=("$argument")
    fi
done

python3 -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or later is needed: it reads TOML")'
[ -x "$environment/bin/pip" ] || python3 -m venv "$environment"
pip() { "$environment/bin/pip" install --quiet --disable-pip-version-check "$@"; }
pip -r "$here/requirements.txt"
for optional in sippy sysidentpy; do
    pip -r "$here/requirements.txt" -r "$here/requirements-$optional.txt" \
        || echo "NOT AVAILABLE: pip could not install requirements-$optional.txt" >&2
done

cargo build --quiet --release --manifest-path "$root/Cargo.toml" -p switchback-benches --bin leafspring_grid
exec "$environment/bin/python" "$here/main.py" "${arguments[@]}"
