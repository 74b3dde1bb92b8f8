# Compiler settings and the few functions every folder uses.
include(GNUInstallDirs)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 11)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
# No more than x86-64-v2: Debian's libraries are plain x86-64, and Eigen's alignment must agree with theirs.
# No contraction: a fused multiply-add would make results depend on the compiler's mood.
add_compile_options(-march=x86-64-v2 -ffp-contract=off)
set(KARST_WARNINGS -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Werror=switch)
if(KARST_WERROR)
  list(APPEND KARST_WARNINGS -Werror)
endif()
if(KARST_SANITIZE)
  add_compile_options(-fsanitize=${KARST_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${KARST_SANITIZE})
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")  # lines for the reports, and assertions
endif()
# g++ looks for garbage from 400 MB of memory on, not from 130 MB: 6 % of a cold build.
add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=400000>)
find_program(CCACHE ccache)
if(CCACHE)
  # By the compiler's own list of headers: preprocessing everything first would cost a tenth of a cold build. Hashes of
  # files are remembered, as a precompiled header has 220 MB. The sloppiness is what ccache's manual asks for with
  # precompiled headers; its -fpch-preprocess is not needed, as CMake includes them by -include.
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_DEPEND=1 CCACHE_INODECACHE=1 CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
endif()
set(CMAKE_UNITY_BUILD ${KARST_UNITY})
set(CMAKE_UNITY_BUILD_BATCH_SIZE 16)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)

# For folders whose code runs in a policy's own process: UBSan's vptr check reads memory through a pipe, which the
# sandbox forbids.
macro(karst_runs_in_sandbox)
  if(KARST_SANITIZE MATCHES undefined)
    add_compile_options(-fno-sanitize=vptr)
  endif()
endmacro()

# Precompiled headers: those of the standard library, Eigen and Boost that most sources include. Not nlohmann/json.hpp,
# which then costs 0.4 s in each source that has no use for it, nor CLI11, whose global validators would be compiled
# with each source. One for libraries and one for tests: programs are compiled with -fPIE. With g++ only, and not under
# sanitizers: what is compiled there, or read by clang-tidy, shows which include a source lacks.
set(KARST_PCH_HEADERS
    <algorithm> <array> <bit> <charconv> <chrono> <cmath> <cstdint> <cstdio> <cstdlib> <cstring> <deque> <filesystem>
    <fstream> <functional> <iterator> <limits> <map> <memory> <mutex> <numbers> <numeric> <optional> <set> <span>
    <sstream> <stdexcept> <string> <string_view> <thread> <tuple> <unordered_map> <utility> <variant> <vector>
    <Eigen/Geometry> <boost/circular_buffer.hpp> <boost/container/small_vector.hpp>
    <boost/property_tree/ptree.hpp>)
set(KARST_USES_PCH OFF)
if(KARST_PCH AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT KARST_SANITIZE)
  set(KARST_USES_PCH ON)
endif()

# karst_pch(NAME headers...): a target whose precompiled headers others use.
function(karst_pch name)
  if(NOT KARST_USES_PCH)
    return()
  endif()
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "// Holds precompiled headers.\n")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE Eigen3::Eigen)
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()
karst_pch(karst_library_pch ${KARST_PCH_HEADERS})

# karst_use_pch(TARGET PCH): for targets of sources in C++ alone.
function(karst_use_pch name pch)
  if(KARST_USES_PCH)
    target_precompile_headers(${name} REUSE_FROM ${pch})
  endif()
endfunction()

# karst_library(NAME sources... [LINK libs...]): a static library with the project's warnings; includes are
# written from the project's root.
function(karst_library name)
  cmake_parse_arguments(A "" "" "LINK" ${ARGN})
  add_library(${name} STATIC ${A_UNPARSED_ARGUMENTS})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_compile_options(${name} PRIVATE ${KARST_WARNINGS})
  target_link_libraries(${name} PUBLIC Eigen3::Eigen Threads::Threads ${A_LINK})
  karst_use_pch(${name} karst_library_pch)
endfunction()

# karst_vehicle(NAME LIBRARIES libs... [FOR_TESTS]): the vehicle plugin libkarst_vehicle_NAME.so of the folder's plugin.cpp,
# which exports one symbol, karst_vehicle_plugin. FOR_TESTS: it is built on request only, and not installed.
function(karst_vehicle name)
  cmake_parse_arguments(A "FOR_TESTS" "" "LIBRARIES" ${ARGN})
  set(target karst_vehicle_${name})
  add_library(${target} MODULE plugin.cpp)
  target_compile_options(${target} PRIVATE ${KARST_WARNINGS})
  target_link_libraries(${target} PRIVATE ${A_LIBRARIES})
  target_link_options(${target} PRIVATE -Wl,--exclude-libs,ALL)
  set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                        LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/karst/vehicles)
  if(A_FOR_TESTS)
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    return()
  endif()
  # Where `karst` looks: next to its own folder, whatever the distribution calls its library folder.
  install(TARGETS ${target} LIBRARY DESTINATION lib/karst/vehicles)
endfunction()

# karst_test(NAME sources... [OPTIMIZED] [LINK libs...] [LABELS labels...]): a GoogleTest program, one CTest entry a
# test. Label "unit" is the default; "flight" marks closed-loop missions. A machine that has no times of its own yet
# starts flights and browsers first, so that no core idles while the last of them runs.
function(karst_test name)
  cmake_parse_arguments(A "OPTIMIZED" "" "LINK;LABELS" ${ARGN})
  if(NOT A_LABELS)
    set(A_LABELS unit)
  endif()
  add_executable(${name} ${A_UNPARSED_ARGUMENTS})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  # Tests name their helpers alike: not more than eight at a time.
  set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 8)
  # What is tested is in libraries that have -O2. -O1 is compiled a quarter sooner, and -O0 in half the time: for
  # folders that set KARST_TESTS_PLAIN, as most of their tests calculate little themselves. With -O1, g++ 12 warns of
  # std::string and std::optional where nothing is wrong (GCC PR 105651, 80635).
  set(level -O1)
  set(pch karst_test_pch)
  if(KARST_TESTS_PLAIN AND NOT A_OPTIMIZED)
    set(level -O0)
    set(pch karst_plain_test_pch)
  endif()
  target_compile_options(${name} PRIVATE ${KARST_WARNINGS} $<$<CONFIG:Release>:${level}>)
  target_compile_options(${name} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-array-bounds -Wno-stringop-overflow
                                         -Wno-stringop-overread -Wno-maybe-uninitialized>)
  target_compile_definitions(${name} PRIVATE KARST_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                             KARST_BINARY_DIR="${CMAKE_BINARY_DIR}")
  target_link_libraries(${name} PRIVATE ${A_LINK} GTest::gtest_main)
  if(NOT "${A_UNPARSED_ARGUMENTS}" MATCHES "\\.c(;|$)")
    karst_use_pch(${name} ${pch})
  endif()
  if(KARST_SANITIZE AND "flight" IN_LIST A_LABELS)  # too slow to fly, and not built
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    return()
  endif()
  set(cost 1)
  if(NOT "unit" IN_LIST A_LABELS)
    set(cost 20)
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES LABELS "${A_LABELS}" TIMEOUT 900 COST ${cost}
                       ENVIRONMENT "RC_PARAMS=seed=20261121")  # property tests try the same cases every time
endfunction()
