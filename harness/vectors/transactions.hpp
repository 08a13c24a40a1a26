// Which transaction a pdu(...) belongs to, where the framing has transactions.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <string_view>

#include "harness/vectors/case.hpp"
#include "src/base/result.hpp"

namespace fieldproof::vectors {

/// Requests of the bench count from 1, over all links of a case; a reply has the number of the
/// request that it answers, the oldest that is open on its link (as the steps name it). A silence
/// leaves none open. Where the device asks, its own number is captured, and the answer
/// on that link carries it.
///
/// begin() for each step in order, next() for each frame of it that asks for a number, end().
class Transactions {
 public:
  /// `client`: the device asks. `low_byte_first`: how a number stands in the frame.
  explicit Transactions(bool client, bool low_byte_first = false)
      : client_(client), low_byte_first_(low_byte_first) {}

  void begin(Step::Kind kind, std::string_view link);
  /// In notation: "00 01". Errors: nothing is open that the frame could answer.
  Result<std::string> next();
  /// The step has named alternatives: the next one answers the same requests.
  void again() { taken_ = 0; }
  void end();

 private:
  bool client_, low_byte_first_;
  int sent_ = 0;
  std::map<std::string, std::deque<int>, std::less<>> open_;  // by link
  Step::Kind kind_ = Step::Kind::send;
  std::string link_;
  std::size_t taken_ = 0, most_taken_ = 0;  // by this step
};

}  // namespace fieldproof::vectors
