// What stands in a mutated source: which mutant this run is of, and which it has come by.
#pragma once

#include <type_traits>

extern "C" int fieldproof_mutant;
extern "C" unsigned char* fieldproof_reached;

inline bool is_mutant(int number) {
  fieldproof_reached[number] = 1;
  return fieldproof_mutant == number;
}
