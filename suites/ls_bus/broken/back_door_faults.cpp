// Faults whose cases begin with a value in a parameter that is read only, or with another order of
// writes.
#include "suites/ls_bus/broken/faults.hpp"

namespace fieldproof::ls_bus_broken {

namespace {

/// Executes a write that the good inverter refuses as read only: its first `words` words; then
/// acknowledges, or not.
MakeBehaviour writes_read_only(std::size_t words, bool acknowledges) {
  return answer_with([=](const FrameText& request, const FrameText& right, GoodInverter& inverter) {
    if (right.content() != "WM") return right;
    const std::string data = request.content().substr(data_at);
    (void)inverter.memory().set(request.content().substr(0, 4), data.substr(0, words * word_size));
    return acknowledges ? ack_to(request, data) : right;
  });
}

bool is_write_to(const FrameText& request, std::string_view address) {
  return request.command() == 'W' && request.content().starts_with(address);
}

/// Tries the other order of address and count where the first is refused.
FrameText guess_order(const FrameText& request, const FrameText& right, GoodInverter& inverter) {
  const std::string content = request.content();
  if (request.command() != 'W' || right.is_ack() || content.size() <= data_at) return right;
  FrameText other = request;
  other.set_content(content[4] + content.substr(0, 4) + content.substr(data_at));
  other.seal();
  const FrameText guessed = take_apart(inverter.answer(other.bytes()));
  return guessed.is_ack() ? guessed : right;
}

/// Reads the address as a decimal number.
void decimal_address(FrameText& request) {
  const std::string content = request.content();
  if (request.command() != 'R' || content.size() < 5 ||
      content.find_first_not_of("0123456789") != std::string::npos)
    return;
  request.set_content(hex_number(std::stoul(content.substr(0, 4)), 4) + content.substr(4));
}

}  // namespace

const std::vector<Fault>& back_door_faults() {
  static const std::vector<Fault> table{
      {"read_only_accepted", "a write to a parameter that is read only is executed",
       writes_read_only(8, true), "errors/read_only/a0003", "header"},
      {"read_only_written_and_refused",
       "a write to a parameter that is read only is refused, and executed",
       writes_read_only(8, false), "errors/read_only/a0003", "0000"},
      {"partial_write_before_read_only",
       "a refused write writes the words before the one that is read only",
       writes_read_only(5, false), "errors/run_into_read_only/last_of_six", "0000"},
      {"ia_for_wm", "a write to a parameter that is read only is refused with IA",
       edit_reply([](FrameText& reply, const FrameText&) {
         if (reply.content() == "WM") reply.set_content("IA");
       }),
       "errors/read_only/a0000", "error code"},
      {"0008_read_only", "the word before the second read-only range is read only too",
       answer_with([](const FrameText& request, const FrameText& right, GoodInverter&) {
         return is_write_to(request, "0008") ? nak_to(request, "WM") : right;
       }),
       "errors/beside_read_only/a0008_1", "header"},
      {"read_only_cannot_be_read", "what is read only is refused when read",
       answer_with([](const FrameText& request, const FrameText& right, GoodInverter&) {
         return request.command() == 'R' && request.content() == "00097" ? nak_to(request, "WM")
                                                                         : right;
       }),
       "read/read_only/a0009_7", "header"},
      {"decimal_address", "the address of a read is taken for decimal", misread(decimal_address),
       "read/hex_address/a0100", "data"},
      {"guesses_the_write_order",
       "a write that is refused in one order of address and count is tried in the other",
       answer_with(guess_order), "write_order/digits_of_the_other_order", "header"},
  };
  return table;
}

}  // namespace fieldproof::ls_bus_broken
