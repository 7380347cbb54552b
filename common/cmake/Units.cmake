# Files of a library are compiled as one unit, since most of their time goes into the same headers and templates. Two files of a library that define one name in their anonymous namespaces are an
# error then. CMake's own way of it, UNITY_BUILD, writes absolute paths, with which a compiler cache finds nothing in
# another checkout.
option(FASTJOINT_UNITS "Compile the files of a library as one; OFF: each by itself, as clang-tidy reads them" ON)

# Sets `result` to the file that stands for these sources, paths relative to the current folder, or to the sources.
function(fastjoint_unit result name)
  if(NOT FASTJOINT_UNITS)
    set(${result} ${ARGN} PARENT_SCOPE)
    return()
  endif()
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE here)
  foreach(source ${ARGN})
    cmake_path(SET path NORMALIZE "${here}/${source}")
    string(APPEND text "#include \"${path}\"\n")
  endforeach()
  file(CONFIGURE OUTPUT ${name}.cpp CONTENT "${text}")
  set(${result} ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp PARENT_SCOPE)
endfunction()

# A static library of these sources.
function(fastjoint_library name)
  fastjoint_unit(unit ${name} ${ARGN})
  add_library(${name} STATIC ${unit})
endfunction()
