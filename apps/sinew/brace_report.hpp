/// @file
/// What `sinew brace` writes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sinew/plan/brace_run.hpp"

#include "arm_scene.hpp"

namespace sinew::cli {

/// The same disturbance with the brace and without.
struct BraceTrial {
  std::uint64_t seed = 0;
  plan::BraceRun braced, bare;
};

/// A run as CSV, a row a step. @param scene of the arm. @param run of it.
std::string brace_table(const ArmScene& scene, const plan::BraceRun& run);

/// The figures. @param scene of the arm. @param task,names objects and what they are called.
/// @param brace found or not. @param trials of it.
nlohmann::ordered_json brace_json(const ArmScene& scene, const plan::BraceTask& task,
                                  const std::vector<std::string>& names, const plan::Brace& brace,
                                  const std::vector<BraceTrial>& trials);

}  // namespace sinew::cli
