# Bare Debian systems to build and try packages in; read by other scripts (`. packaging/root.sh`).
# Needs root and debootstrap.

# make_root RELEASE FOLDER: the smallest Debian of that release (bookworm, trixie), from the mirror that
# apt uses here.
make_root() {
  case $1 in
    bookworm | trixie) ;;
    *) echo "root.sh: say which release: bookworm or trixie, not '$1'" >&2; return 1 ;;
  esac
  [[ $(id -u) == 0 ]] || { echo "root.sh: needs root" >&2; return 1; }
  command -v debootstrap >/dev/null ||
    { echo "root.sh: needs debootstrap: apt-get install debootstrap" >&2; return 1; }
  local mirror
  mirror=$(apt-get indextargets --format '$(ORIGIN) $(SITE)' | awk '$1 == "Debian" { print $2; exit }')
  [[ -n $mirror ]] || { echo "root.sh: apt knows no Debian mirror: apt-get update" >&2; return 1; }
  mkdir -p "$2"
  debootstrap --variant=minbase "$1" "$2" "$mirror" >"$2.log" ||
    { echo "root.sh: debootstrap: $(tail -1 "$2.log")" >&2; return 1; }
}

# bare_system RELEASE: such a system for the script that calls this, in the folder `root`, and beside it the
# folder `work` for its files. Both are taken away when the script ends.
bare_system() {
  work=$(mktemp -d)
  trap 'rm -rf --one-file-system "$work"' EXIT
  trap 'exit 1' HUP INT TERM
  root=$work/system
  make_root "$1" "$root"
}

# inside ROOT COMMAND [FOLDER]: runs a shell command in that system, in /root or the folder given, with
# processes, mounts and terminals of its own that end with the command, and with nothing of this
# environment.
inside() {
  unshare --mount --pid --fork --kill-child --mount-proc="$1/proc" /bin/sh -c '
    mount -t devpts -o newinstance,ptmxmode=0666 devpts "$0/dev/pts" &&
    exec chroot "$0" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
      DEBIAN_FRONTEND=noninteractive /bin/sh -c "cd $2 && $1"' "$1" "$2" "${3:-/root}"
}
