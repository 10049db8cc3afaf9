get_filename_component(_yoro_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET yoro::yoro)
  add_library(yoro::yoro SHARED IMPORTED)
  set_target_properties(yoro::yoro PROPERTIES
    IMPORTED_LOCATION "${_yoro_prefix}/lib/libyoro.so.@VERSION@"
    IMPORTED_SONAME @SONAME@
    INTERFACE_INCLUDE_DIRECTORIES "${_yoro_prefix}/include")
  add_library(yoro::static STATIC IMPORTED)
  set_target_properties(yoro::static PROPERTIES
    IMPORTED_LOCATION "${_yoro_prefix}/lib/libyoro.a"
    INTERFACE_INCLUDE_DIRECTORIES "${_yoro_prefix}/include"
    INTERFACE_LINK_LIBRARIES "@NEEDS@")
endif()
unset(_yoro_prefix)
