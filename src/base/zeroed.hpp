// A fixed number of numbers, all zero: the system clears a page when it is first touched, so that
// the memory of a device costs a case no more than what the case touches of it.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace fieldproof {

template <typename Number>
class Zeroed {
  static_assert(std::is_integral_v<Number>);

 public:
  Zeroed() = default;  // none
  explicit Zeroed(std::size_t size)
      : numbers_(static_cast<Number*>(std::calloc(size, sizeof(Number)))) {
    if (!numbers_ && size > 0) throw std::bad_alloc();
  }

  /// `at` is less than the size.
  Number& operator[](std::size_t at) { return numbers_[at]; }
  const Number& operator[](std::size_t at) const { return numbers_[at]; }

 private:
  struct Free {
    void operator()(Number* numbers) const { std::free(numbers); }
  };
  std::unique_ptr<Number[], Free> numbers_;
};

}  // namespace fieldproof
