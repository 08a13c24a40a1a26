#include "suites/fuzz/targets.hpp"

#include <algorithm>
#include <array>

#include "suites/fuzz/file_targets.hpp"
#include "suites/fuzz/mail_targets.hpp"
#include "suites/fuzz/report_targets.hpp"
#include "suites/fuzz/set_up_targets.hpp"
#include "suites/fuzz/text_targets.hpp"
#include "suites/fuzz/wire_targets.hpp"

namespace fieldproof::fuzz {

namespace {
constexpr std::array every_target{
    Target{"frames", "codecs and stream splitters of all protocols", feed_frames, frames_of_vectors,
           true},
    Target{"devices", "the emulated devices", feed_device, streams_of_vectors, true},
    Target{"memory", "requests for an address and its digits", feed_memory, memory_of_vectors,
           true},
    Target{"clients", "emulated devices that ask", feed_client, good_partners},
    Target{"control", "what a bench tells an emulated device by --control", feed_control,
           good_controls},
    Target{"telnet", "the stream of an RFC 2217 server", feed_telnet, good_telnet},
    Target{"replies", "what an SMTP server says to a module that mails", feed_replies,
           good_replies},
    Target{"mails", "e-mail settings", feed_mail_settings, good_mail_settings},
    Target{"notation", "the notation of frames", feed_notation, good_notation},
    Target{"vectors", "vector files", feed_vectors, good_vectors},
    Target{"profile", "profiles", feed_profile, good_profiles},
    Target{"bench", "bench files", feed_bench, good_benches},
    Target{"waivers", "waivers", feed_waivers, good_waivers},
    Target{"definition", "user-defined frames", feed_definition, good_definitions},
    Target{"journal", "journals", feed_journal, good_journals},
    Target{"results", "results.ndjson", feed_results, good_results},
    Target{"reports", "JSON, JUnit, HTML and tables of results", feed_reports, good_reports},
    Target{"pcapng", "the capture of results", feed_pcapng, good_reports},
    Target{"others", "JSON and JUnit of anybody", feed_others, good_others},
    Target{"monitor", "frames as a monitor shows them, or as people write them", feed_monitor,
           good_monitors},
    Target{"options", "endpoints, line settings, ranges and durations", feed_options, good_options},
    Target{"command", "command lines", feed_command, good_commands}};
}  // namespace

std::span<const Target> targets() { return every_target; }

const Target* find_target(std::string_view name) {
  const auto found = std::ranges::find(every_target, name, &Target::name);
  return found == every_target.end() ? nullptr : &*found;
}

}  // namespace fieldproof::fuzz
