// Faults in what a request is taken for: command, address, count, data (Cnet EN 8.2).
#include <algorithm>
#include <cctype>
#include <charconv>

#include "suites/ls_bus/broken/faults.hpp"

namespace fieldproof::ls_bus_broken {

namespace {

bool is_read(const FrameText& request) {
  return request.command() == 'R' && request.content().size() > count_at;
}
bool is_write(const FrameText& request) {
  return request.command() == 'W' && request.content().size() > count_at;
}

std::string address(const FrameText& request) { return request.content().substr(0, 4); }
char count(const FrameText& request) { return request.content()[count_at]; }
std::string data(const FrameText& request) { return request.content().substr(data_at); }

/// The address `step` further on; one that is not hex stays.
std::string moved(const std::string& digits, unsigned step) {
  const std::optional<Bytes> bytes = from_hex(digits);
  if (!bytes || bytes->size() != 2) return digits;
  return hex_number((static_cast<unsigned>((*bytes)[0] << 8 | (*bytes)[1]) + step) & 0xFFFF, 4);
}

MakeBehaviour moves_address(char command, unsigned step) {
  return misread([=](FrameText& request) {
    if (request.command() == command)
      request.set_content(moved(address(request), step) +
                          request.content().substr(std::min(count_at, request.content().size())));
  });
}

/// Refuses what `refuses` names.
MakeBehaviour refuses(bool (*refuses)(const FrameText& request), std::string_view code) {
  return answer_with([=](const FrameText& request, const FrameText& right, GoodInverter&) {
    return right.is_ack() && refuses(request) ? nak_to(request, code) : right;
  });
}

/// Where the good inverter refuses, acknowledges with what `content` makes of the request.
MakeBehaviour acknowledges(bool (*takes)(const FrameText& request, const FrameText& right),
                           std::string (*content)(const FrameText& request,
                                                  GoodInverter& inverter)) {
  return answer_with([=](const FrameText& request, const FrameText& right, GoodInverter& inverter) {
    return right.is_nak() && takes(request, right) ? ack_to(request, content(request, inverter))
                                                   : right;
  });
}

bool refused_ia_read(const FrameText& request, const FrameText& right) {
  return is_read(request) && right.content() == "IA";
}
bool refused_write(const FrameText& request, const FrameText&) { return is_write(request); }

std::string one_zero(const FrameText&, GoodInverter&) { return "0000"; }

/// The words from the address on, as far as they exist; the rest is `missing`.
std::string read_words(const FrameText& request, GoodInverter& inverter, std::string_view missing) {
  std::string words;
  for (unsigned i = 0; i < static_cast<unsigned>(count(request) - '0'); ++i) {
    const Result<std::string> word = inverter.memory().get(moved(address(request), i), 4);
    words += word ? *word : std::string(missing);
  }
  return words;
}

/// Writes the words that can be written, and acknowledges or refuses as the good inverter does.
MakeBehaviour writes_what_it_can() {
  return answer_with([](const FrameText& request, const FrameText& right, GoodInverter& inverter) {
    const std::string words = is_write(request) && right.is_nak() ? data(request) : "";
    for (std::size_t at = 0; at + word_size <= words.size(); at += word_size)
      if (!inverter.memory().set(moved(address(request), static_cast<unsigned>(at / word_size)),
                                 words.substr(at, word_size)))
        break;
    return right;
  });
}

/// Digits that are not hex count as 0.
void zero_for_foreign(FrameText& request) {
  for (std::size_t i = 3; i < request.body.size(); ++i)
    if (hex_digit(request.body[i]) < 0) request.body[i] = '0';
}

/// Data that are cut short are filled up with zeros, surplus is dropped.
void fit_data(FrameText& request) {
  if (!is_write(request) || count(request) < '1' || count(request) > '8') return;
  std::string digits = data(request);
  digits.resize(word_size * static_cast<unsigned>(count(request) - '0'), '0');
  request.set_content(request.content().substr(0, data_at) + digits);
}

void drop_surplus_of_read(FrameText& request) {
  if (is_read(request)) request.set_content(request.content().substr(0, data_at));
}

void first_word_only(FrameText& request) {
  if (is_write(request) && data(request).size() > word_size)
    request.set_content(address(request) + '1' + data(request).substr(0, word_size));
}

void count_first(FrameText& request) {
  if (is_write(request))
    request.set_content(request.content().substr(1, 4) + request.content()[0] + data(request));
}

void five_digits_will_do(FrameText& request) {
  if (request.command() == 'R' && request.content().size() == 6 && request.content()[0] == '0')
    request.set_content(request.content().substr(1));
}

void swap_address_bytes(FrameText& request) {
  if (is_read(request))
    request.set_content(address(request).substr(2) + address(request).substr(0, 2) +
                        count(request));
}

}  // namespace

std::vector<Fault> request_faults() {
  return {
      {"lower_case_commands", "r and w are taken for R and W", misread([](FrameText& r) {
         if (r.body.size() > 2) r.body[2] = static_cast<char>(std::toupper(r.body[2]));
       }),
       "errors/function/r", "header"},
      {"unknown_function_is_read", "an unknown function is taken for R", misread([](FrameText& r) {
         if (r.command() != 'W' && r.body.size() > 2) r.body[2] = 'R';
       }),
       "errors/function/upper_q", "header"},
      {"silent_on_unknown_function", "an unknown function is not refused",
       spoil_frame([](FrameText& r, const FrameText& request) {
         if (request.command() != 'R' && request.command() != 'W') r.head = 0;
       }),
       "errors/function/upper_q", "no answer"},
      {"count_8_refused", "a read of eight words is refused",
       refuses([](const FrameText& r) { return is_read(r) && count(r) == '8'; }, "ID"),
       "read/count/words_8", "header"},
      {"write_of_8_refused", "a write of eight words, the longest frame, is refused",
       refuses([](const FrameText& r) { return is_write(r) && count(r) == '8'; }, "ID"),
       "write/frame_of_44_bytes/mixed", "header"},
      {"count_9_accepted", "a read of nine words is answered",
       acknowledges(
           [](const FrameText& r, const FrameText&) { return is_read(r) && count(r) == '9'; },
           [](const FrameText& r, GoodInverter& inverter) {
             return read_words(r, inverter, "0000");
           }),
       "errors/count_read/9", "header"},
      {"write_of_9_accepted", "a write of nine words is executed",
       acknowledges(
           [](const FrameText& r, const FrameText&) {
             return is_write(r) && count(r) == '9' && data(r).size() == 36;
           },
           [](const FrameText& r, GoodInverter& inverter) {
             return inverter.memory().set(address(r), data(r)) ? data(r) : std::string();
           }),
       "errors/nine_words", "header"},
      {"count_0_is_1", "a count of 0 is taken for 1", misread([](FrameText& r) {
         if (is_read(r) && count(r) == '0') r.set_content(address(r) + '1');
       }),
       "errors/count_read/0", "header"},
      {"count_0_reads_nothing", "a read of no words is acknowledged",
       acknowledges(
           [](const FrameText& r, const FrameText&) { return is_read(r) && count(r) == '0'; },
           [](const FrameText&, GoodInverter&) { return std::string(); }),
       "errors/count_read/0", "header"},
      {"count_always_1", "every read is of one word", misread([](FrameText& r) {
         if (is_read(r)) r.set_content(address(r) + '1');
       }),
       "read/count/words_2", "data"},
      {"count_one_less", "a read of several words gives one less", misread([](FrameText& r) {
         if (is_read(r) && count(r) > '1')
           r.set_content(address(r) + static_cast<char>(count(r) - 1));
       }),
       "read/count/words_3", "data"},
      {"count_first", "writes are read with the count first", misread(count_first),
       "write/then_read/one", "expected ACK, got NAK"},
      {"reads_one_higher", "reads begin one word higher", moves_address('R', 1), "read/example",
       "data"},
      {"reads_one_lower", "reads begin one word lower", moves_address('R', 0xFFFF), "read/example",
       "data"},
      {"writes_one_higher", "writes begin one word higher", moves_address('W', 1),
       "write/example_address_first", "122F"},
      {"address_bytes_swapped", "reads have the low byte of the address first",
       misread(swap_address_bytes), "read/example", "header"},
      {"low_byte_of_address", "reads look at the low byte of the address alone",
       misread([](FrameText& r) {
         if (is_read(r)) r.set_content("00" + r.content().substr(2));
       }),
       "read/example", "data"},
      {"five_digits_will_do", "the leading zero of an address of five digits is dropped",
       misread(five_digits_will_do), "errors/address_of_five_characters", "header"},
      {"0fff_refused", "a read of the last word of the first range is refused",
       refuses([](const FrameText& r) { return is_read(r) && address(r) == "0FFF"; }, "IA"),
       "ranges/read_inside/a0fff_1", "header"},
      {"1200_refused", "a read of the first word of the second range is refused",
       refuses([](const FrameText& r) { return is_read(r) && address(r) == "1200"; }, "IA"),
       "ranges/read_inside/a1200_1", "header"},
      {"1000_exists", "the word behind the first range is read as 0",
       acknowledges(
           [](const FrameText& r, const FrameText& right) {
             return refused_ia_read(r, right) && address(r) == "1000";
           },
           one_zero),
       "errors/no_such_address_read/a1000", "header"},
      {"11ff_exists", "the word before the second range is read as 0",
       acknowledges(
           [](const FrameText& r, const FrameText& right) {
             return refused_ia_read(r, right) && address(r) == "11FF";
           },
           one_zero),
       "errors/no_such_address_read/a11ff", "header"},
      {"run_cut_at_the_end", "a read across the end of a range gives what there is",
       acknowledges(
           refused_ia_read,
           [](const FrameText& r, GoodInverter& inverter) { return read_words(r, inverter, ""); }),
       "ranges/read_across/a0fff_2", "header"},
      {"zeros_beyond_the_end", "a read across the end of a range gives zeros beyond it",
       acknowledges(refused_ia_read,
                    [](const FrameText& r, GoodInverter& inverter) {
                      return read_words(r, inverter, "0000");
                    }),
       "ranges/read_across/a0fff_2", "header"},
      {"partial_write_at_the_end",
       "a refused write writes the words before the one that is not there", writes_what_it_can(),
       "ranges/write_across/a0fff_2", "0FF"},
      {"partial_write_of_bad_data",
       "a refused write writes the words before the one that is not hex", writes_what_it_can(),
       "errors/data/not_hex_second", "1230"},
      {"first_word_written_alone", "a write of several words writes the first and acknowledges all",
       [] {
         const MakeBehaviour first = misread(first_word_only);
         Behaviour behaviour;
         behaviour.answer = [write = first().answer](const Bytes& frame, bool together,
                                                     GoodInverter& inverter) {
           const FrameText request = take_apart(frame);
           broken::Sendings sendings = write(frame, together, inverter);
           if (is_write(request) && !sendings.front().bytes.empty() &&
               sendings.front().bytes[0] == ls_bus::ls_ack)
             sendings.front().bytes = ack_to(request, data(request)).bytes();
           return sendings;
         };
         return behaviour;
       },
       "write/count/words_2", "12"},
      {"acknowledges_without_writing", "writes are acknowledged and not executed",
       [] {
         Behaviour behaviour;
         behaviour.answer = [](const Bytes& frame, bool, GoodInverter& inverter) {
           const FrameText request = take_apart(frame);
           if (!is_write(request) || data(request).size() % word_size != 0)
             return broken::Sendings{{inverter.answer(frame)}};
           return broken::Sendings{{ack_to(request, data(request)).bytes()}};
         };
         return behaviour;
       },
       "write/example_address_first", "122F"},
      {"writes_one_word_more", "the word behind what is written becomes 0",
       answer_with([](const FrameText& request, const FrameText& right, GoodInverter& inverter) {
         if (is_write(request) && right.is_ack())
           (void)inverter.memory().set(
               moved(address(request), static_cast<unsigned>(count(request) - '0')), "0000");
         return right;
       }),
       "write/frame_of_44_bytes/mixed", "0808"},
      {"surplus_of_read_ignored", "what follows the count of a read is not looked at",
       misread(drop_surplus_of_read), "errors/read_with_surplus/word", "header"},
      {"surplus_data_ignored", "data beyond the count are dropped", misread(fit_data),
       "errors/data/long", "header"},
      {"missing_data_are_zero", "data that are cut short are filled up with zeros",
       misread(fit_data), "errors/data/short", "header"},
      {"foreign_digits_are_zero", "data that are not hex count as 0", misread(zero_for_foreign),
       "errors/data/not_hex", "header"},
      {"foreign_address_is_zero", "digits of an address that are not hex count as 0",
       misread(zero_for_foreign), "errors/address_not_hex/last", "header"},
      {"bad_writes_acknowledged", "every write is acknowledged",
       acknowledges(refused_write, [](const FrameText& r, GoodInverter&) { return data(r); }),
       "errors/no_such_address_write/a1000", "header"},
  };
}

}  // namespace fieldproof::ls_bus_broken
