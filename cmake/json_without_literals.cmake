# g++ instantiates what an inline function calls in each file that sees it, called or not. The literals of json.hpp ("..."_json),
# which nobody here writes, call the whole parser: half a second a file. So they see a
# copy of the header without them.
get_target_property(json_folder nlohmann_json::nlohmann_json INTERFACE_INCLUDE_DIRECTORIES)
list(GET json_folder 0 json_folder)
file(READ ${json_folder}/nlohmann/json.hpp json_header)
string(REGEX REPLACE "JSON_HEDLEY_NON_NULL\\(1\\)\ninline [^\n]* operator *\"\" *_json[^}]*}\n" "" json_header "${json_header}")
string(REGEX REPLACE " *using [^\n]*operator *\"\" *_json[^\n]*\n" "" json_header "${json_header}")
if(NOT json_header MATCHES "operator *\"\" *_json")  # of another version, they may stand there in another form
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/json/nlohmann/json.hpp CONTENT "@json_header@" @ONLY)
  target_include_directories(fieldproof_options SYSTEM BEFORE INTERFACE $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/json>)
endif()
