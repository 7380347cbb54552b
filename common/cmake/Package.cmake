# A Debian package: cmake --preset release && cmake --build --preset package && cpack --preset package
# An archive to unpack anywhere, with its libraries: the same by the preset "archive".
# The manual pages and the completions of bash are made from what the programs say with --help.
find_program(HELP2MAN help2man)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # a package needs no tests

set(purpose_stage1_plate "solve one sheet of a riveted or bolted joint")
set(purpose_stage2_extract "extract stiffness, friction and stresses from a solved sheet")
set(purpose_stage3_nonlinear "find the loads of the fasteners of a joint")
set(completions ${PROJECT_BINARY_DIR}/fastjoint.bash)
foreach(program stage1_plate stage2_extract stage3_nonlinear)
  set(page ${PROJECT_BINARY_DIR}/${program}.1)
  add_custom_command(OUTPUT ${page} DEPENDS ${program} VERBATIM
    COMMAND ${HELP2MAN} --no-info --name ${purpose_${program}} --output ${page} $<TARGET_FILE:${program}>)
  list(APPEND pages ${page})
  list(APPEND programs $<TARGET_FILE:${program}>)
  install(FILES ${completions} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program} OPTIONAL)
endforeach()
add_custom_command(OUTPUT ${completions} DEPENDS ${programs} common/cmake/bash_completion VERBATIM
  COMMAND ${PROJECT_SOURCE_DIR}/common/cmake/bash_completion ${programs} > ${completions})
add_custom_target(pages DEPENDS ${pages} ${completions})
install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)

if(FASTJOINT_BUNDLE)
  set(CPACK_GENERATOR TGZ)
else()
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
endif()
set(CPACK_PACKAGE_CONTACT "The fastjoint developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Needed by the scripts and the examples in addition to the programs.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "make, python3-h5py, python3-matplotlib, python3-meshio, python3-scipy")
include(CPack)
