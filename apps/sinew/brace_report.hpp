/// @file
/// The output of `sinew brace`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sinew/plan/brace_run.hpp"

#include "arm_scene.hpp"

namespace sinew::cli {

/// Two runs under the same disturbance: with the brace and without.
struct BraceTrial {
  std::uint64_t seed = 0;
  plan::BraceRun braced, bare;
};

/// A run as CSV, with one row per step. @param scene of the arm. @param run of the arm.
std::string brace_table(const ArmScene& scene, const plan::BraceRun& run);

/// The results as JSON. @param scene of the arm. @param task that was solved. @param names of its
/// objects. @param brace found or not. @param trials of the brace.
nlohmann::ordered_json brace_json(const ArmScene& scene, const plan::BraceTask& task,
                                  const std::vector<std::string>& names, const plan::Brace& brace,
                                  const std::vector<BraceTrial>& trials);

}  // namespace sinew::cli
