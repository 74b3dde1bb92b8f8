#!/bin/sh
# An author who has nothing but the installed SDK: builds both examples out of tree, runs the policy's own
# test, and sees a plugin refused that exports too much.
# usage: installed_sdk_test.sh SOURCE_DIR BINARY_DIR WORK_DIR
set -eu
source=$1 binary=$2 work=$3
rm -rf "$work" && mkdir -p "$work"
cmake --install "$binary" --component sdk --prefix "$work/karst" > "$work/install.log"
for example in right_hand plain_c; do
  cmake -S "$source/examples/policies/$example" -B "$work/$example" -Dkarst_DIR="$work/karst/lib/cmake/karst" \
        -DCMAKE_BUILD_TYPE=Release > "$work/$example.log"
  cmake --build "$work/$example" >> "$work/$example.log" 2>&1 || { cat "$work/$example.log"; exit 1; }
done
"$work/right_hand/right_hand_test"
"$work/plain_c/deepest_test"
cmake --install "$work/right_hand" --prefix "$work/home/.local" >> "$work/install.log"
test -f "$work/home/.local/share/karst/policies/right_hand.so"

mkdir "$work/leaky"
cat > "$work/leaky/leaky.c" <<'END'
int not_an_entry;
END
cat > "$work/leaky/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(leaky C)
find_package(karst REQUIRED)
karst_add_policy(leaky leaky.c)
END
cmake -S "$work/leaky" -B "$work/leaky/build" -Dkarst_DIR="$work/karst/lib/cmake/karst" > "$work/leaky.log"
if cmake --build "$work/leaky/build" >> "$work/leaky.log" 2>&1; then echo "a plugin without an entry was built"; exit 1; fi
grep -q "must export karst_plugin_entry and nothing else" "$work/leaky.log"
echo "the installed SDK builds policies in C++ and in C, and refuses one without an entry"
