// The shape of a vector and of a file of second entries. vectors/schema.json says the same to
// editors; a test holds the two together.
#pragma once

#include "harness/vectors/json/shape.hpp"

namespace fieldproof::vectors {

/// One vector: an element of the array that a file in vectors/PROTOCOL/ is.
const Shape& vector_shape();

/// All forms of texts that it uses.
std::span<const Form* const> vector_forms();

}  // namespace fieldproof::vectors
