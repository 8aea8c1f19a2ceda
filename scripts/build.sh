#!/usr/bin/env bash
# Configures and builds the program, build/alphadot. Arguments go to the build, e.g. --target alphadot_analysis.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake --preset release
cmake --build --preset release --parallel "$(nproc)" "$@"
