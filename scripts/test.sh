#!/usr/bin/env bash
# Installs, checks the format, builds with warnings as errors in build-test/, looks for the faults that .clang-tidy lists, and runs every
# test. Arguments go to ctest, e.g.
# -L unit for the quick ones alone.
set -euo pipefail
cd "$(dirname "$0")/.."

./scripts/install.sh
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror
cmake --preset test
cmake --build --preset test --parallel "$(nproc)"
cmake --preset tidy
cmake --build --preset tidy --parallel "$(nproc)" --target alphadot alphadot-cgns2su2
# The tests are registered quick ones first; those on several ranks count as so many processes.
ctest --preset test --parallel "$(nproc)" "$@"
