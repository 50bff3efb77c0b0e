#include "sinew/plan/transcription.hpp"

namespace sinew::plan {

namespace {

Weights zeros(int rows, int blocks) {
  const MatrixX zero = MatrixX::Zero(rows, 2 * blocks);
  return {zero, zero, zero};
}

}  // namespace

std::string_view method_name(Method method) {
  return method == Method::backward_euler ? "backward-euler" : "hermite-simpson";
}

Transcription::Transcription(Method method, double h, bool first) {
  if (method == Method::backward_euler) {
    set_euler(h);
  } else if (first) {
    set_radau(h);
  } else {
    set_hermite(h);
  }
}

void Transcription::set_euler(double h) {
  blocks = 2;
  Stage end{zeros(3, blocks), {0.0, 1.0}, 1.0};
  end.state.value << 0.0, 0.0, 1.0, 0.0,  //
      0.0, 0.0, 0.0, 1.0,                 //
      0.0, -1.0 / h, 0.0, 1.0 / h;
  end.state.slope.row(2) << 0.0, 1.0 / (h * h), 0.0, -1.0 / (h * h);
  end.state.bend.row(2) = -2.0 / h * end.state.slope.row(2);
  stages = {end};
  defect = zeros(1, blocks);
  defect.value << -1.0, 0.0, 1.0, -h;
  defect.slope << 0.0, 0.0, 0.0, -1.0;
}

void Transcription::set_hermite(double h) {
  blocks = 3;
  begin_share = 1.0 / 6.0;  // Simpson's rule
  Stage middle{zeros(3, blocks), {0.5, 0.5}, 4.0 / 6.0};
  middle.state.value << 0.5, h / 8.0, 0.0, 0.5, -h / 8.0, 0.0,  //
      0.0, 0.5, h / 8.0, 0.0, 0.5, -h / 8.0,                    //
      0.0, -1.5 / h, -0.25, 0.0, 1.5 / h, -0.25;
  middle.state.slope << 0.0, 0.125, 0.0, 0.0, -0.125, 0.0,  //
      0.0, 0.0, 0.125, 0.0, 0.0, -0.125,                    //
      0.0, 1.5 / (h * h), 0.0, 0.0, -1.5 / (h * h), 0.0;
  middle.state.bend.row(2) = -2.0 / h * middle.state.slope.row(2);
  Stage end{zeros(3, blocks), {0.0, 1.0}, 1.0 / 6.0};
  end.state.value.rightCols(3).setIdentity();
  stages = {middle, end};
  defect = zeros(1, blocks);
  const double squared = h * h / 12.0;
  defect.value << -1.0, -0.5 * h, -squared, 1.0, -0.5 * h, squared;
  defect.slope << 0.0, -0.5, -h / 6.0, 0.0, -0.5, h / 6.0;
  defect.bend << 0.0, 0.0, -1.0 / 6.0, 0.0, 0.0, 1.0 / 6.0;
}

void Transcription::set_radau(double h) {
  blocks = 3;
  Stage third{zeros(3, blocks), {2.0 / 3.0, 1.0 / 3.0}, 0.75};
  third.state.value << 1.0, 5.0 / 27.0 * h, 0.0, 0.0, 4.0 / 27.0 * h, -5.0 / 54.0 * h * h,  //
      0.0, 4.0 / 9.0, 0.0, 0.0, 5.0 / 9.0, -2.0 / 9.0 * h,                                  //
      0.0, -4.0 / (3.0 * h), 0.0, 0.0, 4.0 / (3.0 * h), -1.0 / 3.0;
  third.state.slope << 0.0, 5.0 / 27.0, 0.0, 0.0, 4.0 / 27.0, -5.0 / 27.0 * h,  //
      0.0, 0.0, 0.0, 0.0, 0.0, -2.0 / 9.0,                                      //
      0.0, 4.0 / (3.0 * h * h), 0.0, 0.0, -4.0 / (3.0 * h * h), 0.0;
  third.state.bend(0, 5) = -5.0 / 27.0;
  third.state.bend.row(2) = -2.0 / h * third.state.slope.row(2);
  Stage end{zeros(3, blocks), {0.0, 1.0}, 0.25};
  end.state.value.rightCols(3).setIdentity();
  stages = {third, end};
  defect = zeros(1, blocks);
  defect.value << -1.0, -h / 3.0, 0.0, 1.0, -2.0 / 3.0 * h, h * h / 6.0;
  defect.slope << 0.0, -1.0 / 3.0, 0.0, 0.0, -2.0 / 3.0, h / 3.0;
  defect.bend(0, 5) = 1.0 / 3.0;
}

}  // namespace sinew::plan
