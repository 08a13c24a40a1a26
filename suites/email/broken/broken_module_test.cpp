// The suite against broken modules that mail: each fault must turn its case red, with a message
// that names it, and the healthy module must pass. All in process, in simulated time.
#include "suites/email/broken/broken_module.hpp"

#include <nlohmann/json.hpp>

#include "suites/broken/in_process.hpp"
#include "suites/email/broken/faults.hpp"

namespace fieldproof::email_broken {

using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

constexpr const char* model = "xbc-h";

bool concerns(const Case& one) {
  return one.models.empty() || std::ranges::find(one.models, model) != one.models.end();
}

const broken::Cases& cases() {
  static const broken::Cases all = broken::cases_of("email/*", concerns);
  return all;
}

auto against(const Behaviour& behaviour) {
  return broken::against(model, make_broken_module, behaviour);
}

class EmailSuite : public testing::TestWithParam<Fault> {};

TEST_P(EmailSuite, Catches) {
  broken::expect_caught(GetParam(), cases(),
                        [](const Case& source) { return against(GetParam().make())(source); });
}

INSTANTIATE_TEST_SUITE_P(Broken, EmailSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyModule, PassesTheWholeSuite) { broken::expect_healthy(cases(), 100, against({})); }

TEST(EmailFaultTable, NamesAreUnique) { broken::expect_unique_names(faults(), 60); }

}  // namespace
}  // namespace fieldproof::email_broken
