// A golden as it lies in its folder, and its scene run again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sandbox/run/options.h"
#include "sandbox/run/outputs.h"

namespace shatterbox::sandbox::run {

inline constexpr int kGoldenVersion = 1;

/// What the program says when it refuses or fails.
struct Refusal {
  int status = kBadInput;
  std::string words;
};

/// The words on stderr; the exit status.
int refuse(const Refusal& refusal);

/// A file is kept by its way from the golden's folder, so that both can move together; a name stays a name.
std::string seen_from(const std::filesystem::path& folder, const std::string& file);
std::string file_of(const std::filesystem::path& folder, const std::string& kept);

/// What golden.json says; nothing, with why, if it is none.
std::optional<nlohmann::ordered_json> read_golden(const std::filesystem::path& folder, Refusal& refusal);

/// Names of the goldens in a folder, ascending; those of `wanted` alone, if any are. Folders with pictures of
/// a golden that have lost their golden.json are among them.
std::optional<std::vector<std::string>> find_goldens(const std::string& folder,
                                                     const std::vector<std::string>& wanted,
                                                     Refusal& refusal);

/// The scene, which `who` names, or the scenes of its folder, and the script. What is wrong with them their
/// run tells.
void add_inputs(const nlohmann::ordered_json& golden, const std::filesystem::path& folder,
                const std::string& who, Outputs& outputs);

/// Plays a golden's scene into `work`/frames; its report.
std::optional<nlohmann::json> play_golden(const nlohmann::ordered_json& golden,
                                          const std::filesystem::path& folder,
                                          const std::filesystem::path& work, Refusal& refusal);

/// The hash of the state at the end; of several shots one after the other.
std::string state_of(const nlohmann::json& report);

}  // namespace shatterbox::sandbox::run
