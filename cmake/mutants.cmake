# Mutants of our own devices: src/ with single faults made by rule, in the build folder, as a library of its own beside the
# healthy sources that judge it. `cmake --build DIR --target mutants` runs them.
set(mutants ${PROJECT_BINARY_DIR}/mutants)
file(GLOB mutants_tools CONFIGURE_DEPENDS suites/mutants/*.py suites/mutants/mutant.hpp)
list(FILTER mutants_tools EXCLUDE REGEX "_test\\.py$")
file(GLOB device_sources RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS src/*/*.cpp src/*/*.hpp)
list(FILTER device_sources EXCLUDE REGEX "(_test\\.cpp|/test_[a-z_]*\\.hpp)$")
list(TRANSFORM device_sources PREPEND ${mutants}/ OUTPUT_VARIABLE mutated_sources)
add_custom_command(OUTPUT ${mutated_sources} ${mutants}/mutants.json
  COMMAND /usr/bin/python3 -B ${PROJECT_SOURCE_DIR}/suites/mutants/generate.py ${PROJECT_SOURCE_DIR} ${mutants}
  DEPENDS ${device_sources} ${mutants_tools} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Making mutants" VERBATIM)
add_custom_target(mutated_sources DEPENDS ${mutated_sources} ${mutants}/mutants.json)

# Nothing of it may meet its healthy twin: no name leaves the library but one.
add_library(mutated_options INTERFACE)
target_include_directories(mutated_options INTERFACE ${mutants} ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/suites/mutants)
target_compile_features(mutated_options INTERFACE cxx_std_20)
target_compile_options(mutated_options INTERFACE -w -O1 -fPIC -fvisibility=hidden -fvisibility-inlines-hidden)
target_compile_definitions(mutated_options INTERFACE FIELDPROOF_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
target_link_libraries(mutated_options INTERFACE fmt::fmt nlohmann_json::nlohmann_json OpenSSL::Crypto)
add_library(mutated_devices MODULE suites/mutants/library/device.cpp)
target_link_libraries(mutated_devices PRIVATE mutated_options)
target_link_options(mutated_devices PRIVATE -Wl,-Bsymbolic)
add_dependencies(mutated_devices mutated_sources)

function(mutated_room folder)
  string(REPLACE "/" "_" name mutated_${folder})
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "(_test|/main)\\.cpp$")
  if(folder MATCHES "^src/")
    list(TRANSFORM sources REPLACE "^${PROJECT_SOURCE_DIR}/" "${mutants}/")
  endif()
  add_library(${name} OBJECT ${sources})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  target_link_libraries(${name} PRIVATE mutated_options)
  add_dependencies(${name} mutated_sources)
  target_link_libraries(mutated_devices PRIVATE ${name})
endfunction()
foreach(folder base line net plc p2p xgt_cnet modbus ls_bus user_frames udata xnet hs_link xnet_motion xnet_network xgt_fenet email)
  mutated_room(src/${folder})
endforeach()
foreach(folder reports/results harness harness/notation suites suites/checks suites/services suites/xgt_cnet suites/ls_bus
    suites/modbus suites/user_frames suites/udata suites/xgt_fenet suites/email suites/hs_link suites/xnet)
  mutated_room(${folder})
endforeach()

add_executable(fieldproof_mutants suites/mutants/main.cpp)
target_link_libraries(fieldproof_mutants PRIVATE suites_mutants CLI11::CLI11)
target_link_options(fieldproof_mutants PRIVATE -Wl,--export-dynamic-symbol=fieldproof_mutant,--export-dynamic-symbol=fieldproof_reached)
add_dependencies(fieldproof_mutants mutated_devices)
add_custom_target(mutants
  COMMAND fieldproof_mutants $<TARGET_FILE:mutated_devices> ${mutants}/mutants.json ${PROJECT_SOURCE_DIR}/vectors
    --equivalent ${PROJECT_SOURCE_DIR}/suites/mutants/equivalent.json --out ${mutants} --derived --explore 20000
  USES_TERMINAL VERBATIM)
