// What can be wrong with a module that mails, and the case that finds it.
#pragma once

#include <vector>

#include "suites/broken/fault.hpp"
#include "suites/email/broken/broken_module.hpp"

namespace fieldproof::email_broken {

/// A fault may count: each case meets a new one.
using MakeBehaviour = std::function<Behaviour()>;
using Fault = broken::FaultOf<MakeBehaviour>;

/// All of them.
const std::vector<Fault>& faults();

// The parts of the table.
std::vector<Fault> dialogue_faults();
std::vector<Fault> mail_faults();
std::vector<Fault> result_faults();
std::vector<Fault> event_faults();

// How their rows are made.
MakeBehaviour hears(std::function<std::string(std::string text, Module& module)> change);
MakeBehaviour says(std::function<std::string(std::string text, Module& module)> change);
MakeBehaviour acts(std::function<void(Bursts& does, Module& module)> change);
MakeBehaviour shows(std::function<void(Module& module)> change);
MakeBehaviour ignores(std::function<bool(std::string_view action, const Module& module)> whether);
/// `email` of p2p, or the whole p2p, is another than it is set to.
MakeBehaviour email(std::function<void(nlohmann::json& email)> change);
MakeBehaviour p2p(std::function<void(nlohmann::json& p2p)> change);

/// Each `from` of what is said becomes `to`.
MakeBehaviour says_instead(std::string from, std::string to);
std::string replaced(std::string text, std::string_view from, std::string_view to);
/// Is it the text of a mail?
inline bool is_content(std::string_view text) { return text.starts_with("From: "); }

}  // namespace fieldproof::email_broken
