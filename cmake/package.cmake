# `cpack` makes a Debian package of all that is installed.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fieldproof)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(FIELDPROOF_MAINTAINER "fieldproof developers <fieldproof@fieldproof.invalid>" CACHE STRING "Who answers for a package")
set(CPACK_PACKAGE_CONTACT ${FIELDPROOF_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
# What was built for the tool is enough: all else are tests.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION devel)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Proves, clause by clause of the manual, that a PLC communication module
speaks its protocols: XGT Cnet and FEnet, Modbus, LS Bus and others. Runs
against an emulator, a program, a network device or a serial adapter, and
reports as JUnit, HTML and JSON. Headers and libraries of the protocols are
in it, too.")
# Of the scripts for a farm alone.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3:any")
# Of the headers alone.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "nlohmann-json3-dev, libfmt-dev")
find_program(SHLIBDEPS dpkg-shlibdeps)
if(SHLIBDEPS)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
else()
  message(STATUS "dpkg-shlibdeps is not there (package dpkg-dev): a package made here names no libraries")
endif()

# What Debian wants beside the files of the tool.
find_program(GZIP gzip)
find_program(DATE date)
if(GZIP AND DATE)
  execute_process(COMMAND ${DATE} -u -R -d ${FIELDPROOF_RELEASED} OUTPUT_VARIABLE released OUTPUT_STRIP_TRAILING_WHITESPACE)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/debian-changelog.in ${PROJECT_BINARY_DIR}/package/changelog @ONLY)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/debian-copyright.in ${PROJECT_BINARY_DIR}/package/copyright @ONLY)
  execute_process(COMMAND ${GZIP} -9nfk ${PROJECT_BINARY_DIR}/package/changelog)
  install(FILES ${PROJECT_BINARY_DIR}/package/changelog.gz ${PROJECT_BINARY_DIR}/package/copyright
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/fieldproof)
endif()
include(CPack)
