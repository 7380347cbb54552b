# Compilers go through ccache where it is installed, with settings under which a second clone, in another folder, takes
# every file from the cache: paths relative to the checkout, and precompiled headers told by their content.
option(FASTJOINT_CCACHE "Compile through ccache where it is installed" OFF)
find_program(CCACHE ccache)
mark_as_advanced(CCACHE)
if(FASTJOINT_CCACHE AND CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
  # Both compilers otherwise write into a precompiled header, or ask of it, what differs from one clone to the next.
  if(CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    add_compile_options("SHELL:-Xclang -fno-pch-timestamp")
  else()
    add_compile_options(-fpch-preprocess)
  endif()
endif()
