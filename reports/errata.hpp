// The mistakes of the manuals, each with the sentence that proves it.
#pragma once

#include <string>
#include <vector>

#include "reports/results/case_result.hpp"

namespace fieldproof::reports {

/// By manual and section, in the order in which a person counts.
void sort_errata(std::vector<results::ErratumInfo>& errata);

std::string errata_text(const std::vector<results::ErratumInfo>& errata);
std::string errata_json(const std::vector<results::ErratumInfo>& errata);
/// For the makers: a heading and a table for each manual.
std::string errata_markdown(const std::vector<results::ErratumInfo>& errata);

}  // namespace fieldproof::reports
