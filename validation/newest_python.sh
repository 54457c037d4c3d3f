#!/usr/bin/env bash
# The tests of the Python package with the Python of Debian's next release, for those whose machine has an older one.
#
#     validation/newest_python.sh WHEEL [TEST…]
#
# Root and debootstrap are needed, and a gigabyte in a folder that is removed afterwards. Not run by ./test. Tests of the plug-in of MuJoCo
# are left out: they compile.
set -euo pipefail
wheel="$(realpath "$1")"
shift
cd "$(dirname "$0")/.."
root="$(mktemp -d)"
undo() {
    umount "$root/proc" "$root/dev" "$root/mnt" 2>/dev/null || true
    # Nothing of this machine is below it, even where it could not be unmounted.
    rm -rf --one-file-system "$root" "$root.log"
}
trap undo EXIT
debootstrap --variant=minbase --include=python3,python3-venv,ca-certificates forky "$root" http://deb.debian.org/debian "$(
    ls /usr/share/debootstrap/scripts/{forky,sid} 2>/dev/null | head -1)" >"$root.log" || { tail "$root.log"; exit 1; }
cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
cp /etc/resolv.conf "$root/etc/"
mount --bind . "$root/mnt"
mount --bind /dev "$root/dev"
mount -t proc proc "$root/proc"
cp "$wheel" "$root/opt/"
chroot "$root" env -i PATH=/usr/bin:/bin HOME=/tmp PYTHONDONTWRITEBYTECODE=1 \
    SSL_CERT_FILE=/etc/ssl/certs/ca-certificates.crt bash -euo pipefail -c '
    cd /mnt/crates/palpate-python
    python3 -m venv /opt/tests
    export VIRTUAL_ENV=/opt/tests PATH="/opt/tests/bin:$PATH"
    pip install -q --require-hashes -r tests/uv.txt
    uv pip install -q --require-hashes -r tests/requirements.txt
    uv pip install -q --no-deps /opt/*.whl
    python --version
    python -m pytest -q -p no:cacheprovider -n 2 --dist loadfile "${@:-tests}" --ignore tests/simulators/test_mujoco_plugin.py
' tests "$@"
