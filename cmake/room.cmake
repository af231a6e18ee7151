# motes_room(NAME SOURCES ... USES room... LINKS library...)
#
# A room is one directory of src/ and one target, motes_NAME (alias motes::NAME). USES names the rooms that
# its headers may include, LINKS its outside libraries; script/check-includes keeps the sources to USES.
function(motes_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;LINKS" ${ARGN})
  if(ROOM_SOURCES)
    add_library(motes_${name} STATIC ${ROOM_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(motes_${name} PRIVATE $<BUILD_INTERFACE:motes_compiler>)
  else()
    add_library(motes_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(motes::${name} ALIAS motes_${name})
  set_target_properties(motes_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(motes_${name} ${scope} cxx_std_20)
  target_include_directories(motes_${name} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include/motes>)
  list(TRANSFORM ROOM_USES PREPEND motes_)
  target_link_libraries(motes_${name} ${scope} ${ROOM_USES} ${ROOM_LINKS})
  set_property(GLOBAL APPEND PROPERTY MOTES_ROOMS motes_${name})
endfunction()
