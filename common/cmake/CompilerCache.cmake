# Compilers go through ccache where it is installed, with settings under which a second clone, in another folder, takes
# every file from the cache.
option(FASTJOINT_CCACHE "Compile through ccache where it is installed" OFF)
find_program(CCACHE ccache)
mark_as_advanced(CCACHE)
if(FASTJOINT_CCACHE AND CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=time_macros,include_file_mtime,include_file_ctime ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()
