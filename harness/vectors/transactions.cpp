#include "harness/vectors/transactions.hpp"

#include <algorithm>

namespace fieldproof::vectors {

void Transactions::begin(Step::Kind kind, std::string_view link) {
  kind_ = kind;
  link_ = link;
  taken_ = most_taken_ = 0;
}

Result<std::string> Transactions::next() {
  ++taken_;
  most_taken_ = std::max(most_taken_, taken_);
  if (client_) {
    const std::string name = link_.empty() ? "transaction" : "transaction_" + link_;
    return '{' + name + (kind_ == Step::Kind::expect ? ":2}" : "}");
  }
  int number = sent_ + static_cast<int>(taken_);
  if (kind_ == Step::Kind::expect) {
    const std::deque<int>& open = open_[link_];
    if (taken_ > open.size())
      return fail("pdu(...) answers no request that is still open; write the whole frame");
    number = open[taken_ - 1];
  }
  const std::string high = hex_number(static_cast<unsigned>(number) >> 8 & 0xFF, 2);
  const std::string low = hex_number(static_cast<unsigned>(number) & 0xFF, 2);
  return low_byte_first_ ? low + ' ' + high : high + ' ' + low;
}

void Transactions::end() {
  std::deque<int>& open = open_[link_];
  if (kind_ == Step::Kind::send)  // a request that is written out has a number, too
    for (std::size_t i = 0; i < std::max<std::size_t>(1, most_taken_); ++i) open.push_back(++sent_);
  if (kind_ == Step::Kind::expect)
    open.erase(open.begin(),
               open.begin() + static_cast<std::ptrdiff_t>(
                                  std::min(open.size(), std::max<std::size_t>(1, most_taken_))));
  if (kind_ == Step::Kind::silence) open.clear();
}

}  // namespace fieldproof::vectors
