# g++ instantiates what an inline function calls in each file that sees it, called or not. The
# literals of json.hpp ("..."_json), which nobody here writes, call the whole parser: half a second
# a file. So they see a copy of the header without them; a header of another version, in which they
# stand in another form, is used as it is.
get_target_property(json_folder nlohmann_json::nlohmann_json INTERFACE_INCLUDE_DIRECTORIES)
list(GET json_folder 0 json_folder)
set(json_header_file ${json_folder}/nlohmann/json.hpp)
if(NOT EXISTS ${json_header_file})
  return()
endif()
# An upgrade of the package makes the copy anew.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${json_header_file})
file(READ ${json_header_file} json_header)
string(REGEX REPLACE "JSON_HEDLEY_NON_NULL\\(1\\)\ninline [^\n]* operator *\"\" *_json[^}]*}\n" ""
                     json_header "${json_header}")
string(REGEX REPLACE " *using [^\n]*operator *\"\" *_json[^\n]*\n" "" json_header
                     "${json_header}")
if(NOT json_header MATCHES "operator *\"\" *_json")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/json/nlohmann/json.hpp CONTENT "@json_header@" @ONLY)
  target_include_directories(fieldproof_options SYSTEM BEFORE INTERFACE
                             $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/json>)
endif()
