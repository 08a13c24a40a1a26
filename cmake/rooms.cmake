# A room: the library of one folder (`x.cpp`) and the tests beside it (`x_test.cpp`). What it may
# include is what it links.
#
# Most of the time of a clean build goes into what every file reads and instantiates anew: headers,
# JSON, GoogleTest. Builds of run.sh and CI therefore compile many rooms at once, a wing of the
# house each, and their tests likewise; CTest still runs those of each room alone.
option(FIELDPROOF_UNITY "Compile each wing of the house in one piece" OFF)
set(wings
  "src_network=^src_xnet_network$"
  "src=^src_"
  "reports=^reports"
  "harness_tool=^harness_(system|endpoints|hosting|probe|explore|run|usage|cli)"
  "harness=^harness"
  "suites_tool=^suites_tool$"
  "suites_broken=^suites_(.*broken|noise|faults)$"
  "suites_aside=^suites_(mutants|fuzz)$"
  "suites=^suites")

function(in_one_piece target)
  if(FIELDPROOF_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  endif()
endfunction()

# Optimising or checking the tests themselves, and their broken devices, not what they test, would
# double the time of a clean build.
function(is_test target)
  set_target_properties(${target} PROPERTIES IS_TEST ON)
  target_compile_options(${target} PRIVATE -O0 $<$<BOOL:${FIELDPROOF_SANITIZE}>:-g0>)
endfunction()

# The headers that most files read, compiled once: half of the time of a clean build else.
# -fpch-preprocess: so that ccache can tell which one was used.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(fieldproof_options INTERFACE $<BUILD_INTERFACE:-fpch-preprocess>)
endif()
set(pch_headers <algorithm> <array> <chrono> <cstdint> <functional> <map> <memory> <optional> <span> <string> <string_view>
  <variant> <vector> <fmt/format.h> <fmt/ranges.h> <nlohmann/json.hpp>)
function(precompiled name)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE fieldproof_options fmt::fmt nlohmann_json::nlohmann_json ${ARGN})
  target_precompile_headers(${name} PRIVATE ${pch_headers} $<$<BOOL:${FIELDPROOF_SANITIZE}>:${PROJECT_SOURCE_DIR}/cmake/json_once.hpp>)
endfunction()
precompiled(fieldproof_pch)
if(FIELDPROOF_TESTS)
  precompiled(fieldproof_tests_pch GTest::gmock)
  target_precompile_headers(fieldproof_tests_pch PRIVATE <gmock/gmock.h> <gtest/gtest.h>)
  is_test(fieldproof_tests_pch)
endif()
# Rooms that neither format nor read JSON.
set(without_pch src_base src_line)

# The wing of a room; without wings, and for all that is no room, its own name.
function(wing_of name wing)
  set(${wing} ${name} PARENT_SCOPE)
  if(NOT FIELDPROOF_UNITY)
    return()
  endif()
  foreach(one ${wings})
    string(REPLACE "=" ";" parts ${one})
    list(GET parts 1 rooms)
    if(name MATCHES "${rooms}")
      list(GET parts 0 one)
      set(${wing} ${one} PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# The target that compiles the sources of a room, and that of its tests.
function(library_of name library)
  wing_of(${name} wing)
  set(${library} ${name} PARENT_SCOPE)
  if(FIELDPROOF_UNITY)
    set(${library} wing_${wing} PARENT_SCOPE)
  endif()
endfunction()
function(tests_of name tests)
  wing_of(${name} wing)
  set(${tests} ${wing}_tests PARENT_SCOPE)
endfunction()

function(compile_library library name)
  add_library(${library} STATIC)
  target_link_libraries(${library} PUBLIC fieldproof_options)
  in_one_piece(${library})
  if(FIELDPROOF_TESTS AND name MATCHES "_(broken|faults|noise)$")  # devices that are wrong on purpose
    is_test(${library})
    target_link_libraries(${library} PRIVATE GTest::gmock)
    target_precompile_headers(${library} REUSE_FROM fieldproof_tests_pch)
  elseif(FIELDPROOF_UNITY OR NOT name IN_LIST without_pch)
    target_link_libraries(${library} PRIVATE fmt::fmt nlohmann_json::nlohmann_json)
    target_precompile_headers(${library} REUSE_FROM fieldproof_pch)
  endif()
  # What runs take their time in: a fifth of that of all tests, for a twentieth of that of a build.
  if(FIELDPROOF_SANITIZE AND library MATCHES "^wing_(src|src_network|harness|suites)$")
    target_compile_options(${library} PRIVATE -O1)
  endif()
endfunction()

function(compile_tests tests name)
  add_executable(${tests})
  is_test(${tests})
  in_one_piece(${tests})
  target_compile_definitions(${tests} PRIVATE FIELDPROOF_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  if(FIELDPROOF_UNITY)
    target_sources(${tests} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/tests_of_rooms.cpp)
    target_link_libraries(${tests} PRIVATE GTest::gmock)
  else()
    target_link_libraries(${tests} PRIVATE GTest::gmock_main)
  endif()
  if(FIELDPROOF_UNITY OR NOT name IN_LIST without_pch)
    target_link_libraries(${tests} PRIVATE fmt::fmt nlohmann_json::nlohmann_json)
    target_precompile_headers(${tests} REUSE_FROM fieldproof_tests_pch)
  endif()
endfunction()

# room(FOLDER WHAT_IT_LINKS...)
function(room folder)
  string(REPLACE "/" "_" name ${folder})
  library_of(${name} library)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  set(tests ${sources})
  list(FILTER sources EXCLUDE REGEX "(_test|/main)\\.cpp$")
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  if(sources)
    if(NOT TARGET ${library})
      compile_library(${library} ${name})
    endif()
    target_sources(${library} PRIVATE ${sources})
    foreach(linked ${ARGN})
      library_of(${linked} other)
      if(NOT other STREQUAL library)
        target_link_libraries(${library} PUBLIC ${linked})
      endif()
    endforeach()
  endif()
  if(NOT TARGET ${name})
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE fieldproof_options ${ARGN} $<$<BOOL:${sources}>:${library}>)
  endif()
  if(FIELDPROOF_TESTS AND tests)
    room_tests(${folder} ${name} "${tests}")
  endif()
endfunction()

# NAME_parts, if it is set, has PART=FILTER of GoogleTest: tests that CTest runs apart; NAME has the rest.
function(room_tests folder name sources)
  tests_of(${name} tests)
  if(NOT TARGET ${tests})
    compile_tests(${tests} ${name})
  endif()
  target_sources(${tests} PRIVATE ${sources})
  target_link_libraries(${tests} PRIVATE ${name})
  set(room "")
  if(FIELDPROOF_UNITY)
    set(room --room=${folder})
  endif()
  set(names ${name})
  foreach(part ${${name}_parts})
    string(REGEX MATCH "^([a-z]+)=(.*)$" matched ${part})
    list(APPEND names ${name}_${CMAKE_MATCH_1})
    list(APPEND of_parts ${CMAKE_MATCH_2})
    add_test(NAME ${name}_${CMAKE_MATCH_1} COMMAND ${tests} "--gtest_filter=${CMAKE_MATCH_2}")
  endforeach()
  if(of_parts)
    list(JOIN of_parts ":" rest)
    set(rest "--gtest_filter=-${rest}")
  endif()
  add_test(NAME ${name} COMMAND ${tests} ${room} ${rest})
  # Labels: of single units, of the built tool, of the tool against broken devices and independent peers.
  set(group unit)
  if(folder STREQUAL suites/tool)
    set(group tool)
  elseif(folder MATCHES "/(broken|tcp_broken|peers|second_hand|example)$")
    set(group devices)
  endif()
  set_tests_properties(${names} PROPERTIES LABELS ${group} TIMEOUT 900)
endfunction()

# Of one room, whatever compiles it: what it defines, what its tests link beyond it.
function(room_defines name kind)
  library_of(${name} library)
  target_compile_definitions(${library} ${kind} ${ARGN})
endfunction()
function(room_tests_link name)
  tests_of(${name} tests)
  target_link_libraries(${tests} PRIVATE ${ARGN})
endfunction()
