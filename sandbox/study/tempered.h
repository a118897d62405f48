// Tempered glass: its dice beside the counts that EN 12150-1 asks for. A part of the study `fragments`.
#pragma once

#include <string>
#include <vector>

#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

/// Adds the tables `tempered` and `tempered-stress`, and their jobs.
void add_tempered(Plan& plan, bool is_quick);

/// What follows from one of them; nothing of other tables.
std::vector<std::string> conclude_tempered(const Table& table);

}  // namespace shatterbox::sandbox::study
