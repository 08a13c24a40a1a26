#define FIELDPROOF_JSON_ONCE
#include "cmake/json_once.hpp"
