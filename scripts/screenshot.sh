#!/usr/bin/env bash
# Picture of a report as Debian's chromium shows it, e.g. for the README or to check it at the width of a phone:
#
#   scripts/screenshot.sh REPORT.html OUTPUT.png [WIDTH [HEIGHT]]      default 1280 by 2000
set -euo pipefail

stop() {
  echo "screenshot.sh: $*" >&2
  exit 1
}

(($# >= 2 && $# <= 4)) || stop "usage: screenshot.sh REPORT.html OUTPUT.png [WIDTH [HEIGHT]]"
command -v chromium >/dev/null || stop "needs the Debian package chromium"
page=$(realpath "$1") picture=$(realpath "$2") width=${3:-1280} height=${4:-2000}
[[ -r $page ]] || stop "cannot read $page"

profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
# A window of chromium is no narrower than 500 pixels, a frame in it can be: the page then sees the width of a phone.
frame=$profile/frame.html
style="margin:0;border:0;width:${width}px;height:${height}px"
printf '<body style="margin:0"><iframe src="file://%s" style="%s" scrolling="no"></iframe></body>' "$page" "$style" > "$frame"

chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking \
  --disable-component-update --disable-sync --user-data-dir="$profile/chromium" --hide-scrollbars \
  --window-size="$((width < 500 ? 500 : width)),$height" --screenshot="$profile/shot.png" "file://$frame" 2> "$profile/log" \
  || stop "$(tail -n 1 "$profile/log")"

# Cut to the page, and in 256 colours a third of the size.
/usr/bin/python3 - "$profile/shot.png" "$picture" "$width" <<'END'
import sys
from PIL import Image
source, target, width = sys.argv[1:]
shot = Image.open(source).convert("RGB")
shot.crop((0, 0, int(width), shot.height)).quantize(256, dither=Image.Dither.NONE).save(target, optimize=True)
END
