# motes_simd_sources(FILE...): sources that Highway compiles once for each instruction set. One build serves
# every x86 machine: SSE4, AVX2, AVX-512 (Highway's AVX3), chosen at run time, the same for all sources.
function(motes_simd_sources)
  set(without "HWY_SSSE3 | HWY_AVX3_DL")
  # The release tests judge all instruction sets. Of the sanitizers, which take longest here, that of addresses sees the
  # narrowest and the widest vectors, that of threads one: what they share is the same for all.
  if(MOTES_SANITIZE STREQUAL "thread")
    string(APPEND without " | HWY_AVX2 | HWY_AVX3")
  elseif(MOTES_SANITIZE)
    string(APPEND without " | HWY_AVX2")
  endif()
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_DEFINITIONS "HWY_DISABLED_TARGETS=(${without})")
  # SSE4 is the least that is asked for, so that no scalar copy is built beside it.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set_source_files_properties(${ARGN} PROPERTIES
      COMPILE_OPTIONS "-msse4.2;-maes;-mpclmul;$<$<CONFIG:Release>:-O3>")
  endif()
  # GCC 12 warns of its own AVX-512 intrinsics, which start from undefined vectors on purpose.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -Wno-maybe-uninitialized)
  endif()
endfunction()
