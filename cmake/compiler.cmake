# Warnings, sanitizers, and the compiler cache and faster linker where they are installed.

set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
# The sanitizer builds: asserts stay on. Reports need lines; variables would take a third of the build's time.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  string(APPEND CMAKE_CXX_FLAGS_RELWITHDEBINFO " -fno-var-tracking-assignments")
endif()

add_library(motes_compiler INTERFACE)
target_compile_options(motes_compiler INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wunused -Woverloaded-virtual
  -Werror=return-type
  # Results must not depend on errno or on trapping; NaN and infinity keep their meaning.
  -fno-math-errno -fno-trapping-math)
if(MOTES_SANITIZE)
  add_compile_options(-fsanitize=${MOTES_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${MOTES_SANITIZE})
endif()
if(MOTES_SANITIZE MATCHES "undefined")
  # What the address sanitizer and the processor find by themselves: checked at each use of a pointer it would take a
  # third of the compiler's time, and two thirds where vectors are loaded.
  add_compile_options(-fno-sanitize=null,alignment,object-size,pointer-overflow)
endif()
if(MOTES_SANITIZE MATCHES "address" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Checks of addresses as calls, not spelled out at each use: a seventh less to compile, a third to two thirds where
  # vectors are loaded.
  add_compile_options(--param=asan-instrumentation-with-call-threshold=0)
endif()
if(MOTES_SANITIZE STREQUAL "thread")
  # Programs (not libraries) take what shows oneTBB's synchronisation to the sanitizer.
  add_library(motes_tsan_tbb OBJECT ${PROJECT_SOURCE_DIR}/tests/support/tsan_tbb.cc)
  target_sources(motes_compiler INTERFACE
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:$<TARGET_OBJECTS:motes_tsan_tbb>>)
  link_libraries(TBB::tbb)
endif()
if(MOTES_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()
find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM)
  add_link_options(-fuse-ld=mold)
endif()
