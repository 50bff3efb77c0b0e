/// @file
/// Describes which limits of actuators contradict each other.
#pragma once

#include <string>

#include "sinew/core/types.hpp"

namespace sinew::qp {
struct ElasticResult;
struct QuadraticProgram;
}  // namespace sinew::qp
namespace sinew::model {
class Model;
}
namespace sinew::law {
class Response;
}

namespace sinew::control {

/// Describes a conflict of limits, such as "displacement of 'east' leaves -0.01..0.01 m by 0.003 m;
/// tension of 'east' is at its limit, 3 N".
/// @param model of the robot. @param response of the controlled actuators; each has one variable
///   and one row of the program.
/// @param program with efforts over `scale` as variables. @param scale (controlled,) N or Pa, > 0.
/// @param nearest its solution: the relaxed rows, and the bounds that prevent them from being met.
std::string describe_conflict(const model::Model& model, const law::Response& response,
                              const qp::QuadraticProgram& program, const VectorX& scale,
                              const qp::ElasticResult& nearest);

}  // namespace sinew::control
