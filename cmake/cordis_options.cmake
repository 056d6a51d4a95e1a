# What every target of Cordis is compiled with.
add_library(cordis_options INTERFACE)
target_compile_features(cordis_options INTERFACE cxx_std_20)
target_include_directories(cordis_options INTERFACE ${PROJECT_SOURCE_DIR})
# No contraction and no fast-math: a recording must replay bit for bit on every machine.
target_compile_options(cordis_options INTERFACE
  -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  # std::stable_sort of the library of g++ 12; names of another source that is compiled at once, which g++ does not count.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations$<SEMICOLON>-Wno-shadow>)

# What is not the engine compiles in a fifth less time than with -O3, and waits for others anyway.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")

# Faults of memory end a program instead of serving a stranger: bounds of the standard C functions and stack frames are
# checked, and what a loader writes is read-only afterwards. Debian's compilers make position-independent programs. None of it changes a result; docs/security.md.
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT CORDIS_SANITIZE)
  target_compile_options(cordis_options INTERFACE
    -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3 -fstack-protector-strong -fstack-clash-protection
    $<$<STREQUAL:${CMAKE_SYSTEM_PROCESSOR},x86_64>:-fcf-protection>)
  target_link_options(cordis_options INTERFACE -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
endif()

# No object file depends on the folder of the clone: ccache, where it is installed, serves every clone (./cordis sets it up).
add_compile_options(-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=)
find_program(CORDIS_CCACHE ccache)
if(CORDIS_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CORDIS_CCACHE})
endif()

# A newer compiler may warn of more: a warning ends only the builds of those who change Cordis, and of CI.
option(CORDIS_WERROR "Treat warnings as errors" "$ENV{CORDIS_WERROR}")
if(CORDIS_WERROR)
  target_compile_options(cordis_options INTERFACE -Werror)
endif()

# Preconditions are checked in debug and sanitizer builds (node/assert.h), those of the
# standard library too.
if(CORDIS_SANITIZE OR CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_definitions(cordis_options INTERFACE CORDIS_ASSERTIONS _GLIBCXX_ASSERTIONS)
endif()

if(CORDIS_SANITIZE)
  target_compile_options(cordis_options INTERFACE
    -fsanitize=${CORDIS_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # g++ 12 has false alarms about the standard library
  if(NOT CORDIS_FUZZ)  # what mostly ends the program anyway takes a third of the time of a compiler
    target_compile_options(cordis_options INTERFACE
      -fno-sanitize=null,object-size,vptr,nonnull-attribute,returns-nonnull-attribute)
  endif()
  target_link_options(cordis_options INTERFACE -fsanitize=${CORDIS_SANITIZE})
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
