#include "sinew/pcc/excitation.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/random.hpp"

namespace sinew::pcc {

double BretschneiderSpectrum::density(double frequency) const {
  const double ratio = std::pow(peak / frequency, 4);
  return 0.3125 * ratio / frequency * height * height * std::exp(-1.25 * ratio);
}

double BretschneiderSpectrum::energy(double frequency) const {
  if (frequency <= 0.0) return 0.0;
  return height * height / 16.0 * std::exp(-1.25 * std::pow(peak / frequency, 4));
}

Excitation::Excitation(const ExcitationSettings& settings) {
  const auto require = [](bool good, const std::string& message, const char* remedy) {
    if (!good) throw Error(ErrorKind::out_of_range, {.item = "excitation"}, message, remedy);
  };
  require(settings.amplitude > 0.0 && std::isfinite(settings.amplitude),
          fmt::format("the amplitude is {:g}", settings.amplitude), "give more than zero");
  require(settings.peak_frequency > 0.0 && std::isfinite(settings.peak_frequency),
          fmt::format("the spectrum's peak is at {:g} Hz", settings.peak_frequency),
          "give more than zero");
  require(settings.lowest >= 0.0 && settings.highest > settings.lowest &&
              std::isfinite(settings.highest),
          fmt::format("the band is {:g} to {:g} Hz", settings.lowest, settings.highest),
          "give 0 <= lowest < highest");
  require(settings.sines >= 1 && settings.sines <= 100000,
          fmt::format("there are {} sines", settings.sines), "give 1 to 100000");
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const BretschneiderSpectrum spectrum{kTurn * settings.peak_frequency, 2.0 * settings.amplitude};
  Random random(settings.seed);
  const double from = kTurn * settings.lowest,
               width = kTurn * (settings.highest - settings.lowest) / settings.sines;
  for (int i = 0; i < settings.sines; ++i) {
    const double low = from + i * width, high = low + width;
    const double energy = spectrum.energy(high) - spectrum.energy(low);
    const double frequency = random.uniform(low, high);
    sines_.push_back({std::sqrt(2.0 * energy), frequency, random.uniform(0.0, kTurn)});
  }
}

double Excitation::at(double time) const {
  double sum = 0.0;
  for (const Sine& s : sines_) sum += s.amplitude * std::sin(s.frequency * time + s.phase);
  return sum;
}

VectorX Excitation::sample(const VectorX& times) const {
  return times.unaryExpr([this](double time) { return at(time); });
}

}  // namespace sinew::pcc
