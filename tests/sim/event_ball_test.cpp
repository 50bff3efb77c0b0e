// A bouncing ball against the closed form of its flights.
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "event_robots.hpp"

namespace sinew::testing {
namespace {

constexpr double kHeight = 0.5;  // m, of the lowest point above the floor
constexpr double kRadius = 0.05;

// On a floor inclined by `slope`, rad.
std::unique_ptr<sim::Simulation> ball(double time_step, double restitution, double slope) {
  builder::ModelBuilder builder(events(time_step, restitution));
  const Vector3 normal(std::sin(slope), 0.0, std::cos(slope));
  add_floor(builder, add_ball(builder, "ball", (kHeight * std::cos(slope) + kRadius) * normal),
            normal);
  return std::make_unique<sim::Simulation>(builder.build());
}

// Normal to the floor, the ball falls with g cos(slope) from the height h cos(slope), so its
// flights last as long as on a level floor.
struct Flights {
  Flights(double e, double slope) : fall(kGravity * std::cos(slope)), restitution(e) {}

  double end() const { return first * (1.0 + restitution) / (1.0 - restitution); }
  // Height (m) and velocity (m/s) normal to the floor, and time (s) of the last impact.
  struct Place {
    double height = 0.0, rate = 0.0, begin = 0.0;
  };
  Place at(double time) const {
    if (time < first) return {0.5 * fall * (first * first - time * time), -fall * time, 0.0};
    Place place{0.0, 0.0, first};
    double speed = restitution * fall * first;
    while (speed > 1e-14) {
      const double flight = 2.0 * speed / fall, t = time - place.begin;
      if (t < flight) return {speed * t - 0.5 * fall * t * t, speed - fall * t, place.begin};
      place.begin += flight;
      speed *= restitution;
    }
    return place;
  }

  double fall, restitution;  // fall: m/s^2
  double first = std::sqrt(2.0 * kHeight / kGravity);
};

struct BallCase {
  double slope, restitution, step;
};

class BouncingBall : public ::testing::TestWithParam<BallCase> {
 protected:
  Vector3 normal() const { return {std::sin(GetParam().slope), 0.0, std::cos(GetParam().slope)}; }
  double gap(const sim::Simulation& simulation) const {
    return normal().dot(pose(simulation, 0).origin()) - kRadius;
  }
  double rate(const sim::Simulation& simulation) const {
    return normal().dot(pose(simulation, 0).linear_velocity());
  }
  Flights flights() const { return {GetParam().restitution, GetParam().slope}; }
};

TEST_P(BouncingBall, FollowsItsFlights) {
  const auto [slope, e, h] = GetParam();
  const auto simulation = ball(h, e, slope);
  const Flights flights = this->flights();
  while (simulation->time() < 0.9 * flights.end()) {
    simulation->step();
    const double time = simulation->time(), height = gap(*simulation), speed = rate(*simulation);
    const Flights::Place place = flights.at(time);
    EXPECT_NEAR(height, place.height, 1e-10);
    EXPECT_NEAR(speed, place.rate, 1e-8);
    // Time of the last impact, computed back from the present flight.
    const double left = std::sqrt(speed * speed + 2.0 * flights.fall * height);
    const double begin = time - (left - speed) / flights.fall;
    if (time > flights.first) {
      EXPECT_NEAR(begin, place.begin, 1e-8 * time);
    }
  }
}

// Along the slope only gravity acts.
TEST_P(BouncingBall, SlidesFreely) {
  const auto [slope, e, h] = GetParam();
  const auto simulation = ball(h, e, slope);
  while (simulation->time() < 1.2 * flights().end()) simulation->step();
  const Vector3 along(std::cos(slope), 0.0, -std::sin(slope));
  const double pull = kGravity * std::sin(slope), time = simulation->time();
  EXPECT_NEAR(along.dot(pose(*simulation, 0).origin()), 0.5 * pull * time * time,
              1e-9 * time * time);
  EXPECT_NEAR(gap(*simulation), 0.0, 1e-9);
  EXPECT_NEAR(rate(*simulation), 0.0, 1e-11);
}

// The steps end 0.1 % before, and 0.1 % after, the closed form's time of rest.
TEST_P(BouncingBall, ComesToRestInTime) {
  const auto [slope, e, h] = GetParam();
  const double end = flights().end();
  const int steps = static_cast<int>(std::ceil(end / h));
  for (const double part : {0.999, 1.001}) {
    const auto simulation = ball(part * end / steps, e, slope);
    for (int k = 0; k < steps; ++k) simulation->step();
    if (part < 1.0) {
      EXPECT_GT(std::hypot(rate(*simulation), std::sqrt(2.0 * kGravity * gap(*simulation))), 1e-4);
    } else {
      EXPECT_LT(std::abs(rate(*simulation)), 1e-11);
      EXPECT_EQ(simulation->step().impacts, 0);
    }
  }
}

// Energy is constant between impacts; each impact leaves e^2 of the energy normal to the floor.
TEST_P(BouncingBall, LosesEnergyInImpactsAlone) {
  const auto [slope, e, h] = GetParam();
  const auto simulation = ball(h, e, slope);
  const double whole = 2.0 * kGravity * kHeight;  // J, m g h
  double before = simulation->energies().total(), dissipated = 0.0;
  double across = whole * std::cos(slope) * std::cos(slope);
  while (simulation->time() < 0.9 * flights().end()) {
    const int impacts = simulation->step().impacts;
    const double now = simulation->energies().total();
    const double left = across * std::pow(e, 2 * impacts);
    EXPECT_NEAR(before - now, across - left, 1e-9 * whole);
    EXPECT_LE(now, before + 1e-9 * whole);
    EXPECT_NEAR(simulation->ledger().dissipated - dissipated, across - left, 1e-9 * whole);
    dissipated = simulation->ledger().dissipated;
    before = now;
    across = left;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, BouncingBall,
                         ::testing::Values(BallCase{0.0, 0.5, 1e-3}, BallCase{0.0, 0.9, 1e-3},
                                           BallCase{0.0, 0.5, 20e-3}, BallCase{0.0, 0.9, 20e-3},
                                           BallCase{0.3, 0.5, 20e-3}, BallCase{0.3, 0.9, 20e-3}));

TEST(EventDriven, AnElasticBallBouncesForEver) {
  const auto simulation = ball(20e-3, 1.0, 0.0);
  const double start = simulation->energies().total();
  int impacts = 0;
  while (simulation->time() < 20.0) impacts += simulation->step().impacts;
  EXPECT_EQ(impacts, static_cast<int>(std::floor(0.5 + 0.5 * 20.0 / Flights(1.0, 0.0).first)));
  EXPECT_NEAR(simulation->energies().total(), start, 1e-9 * 2.0 * kGravity * kHeight);
}

TEST(EventDriven, WithoutRestitutionItStaysWhereItLands) {
  const auto simulation = ball(20e-3, 0.0, 0.0);
  int impacts = 0;
  while (simulation->time() < 1.0) impacts += simulation->step().impacts;
  EXPECT_EQ(impacts, 1);
  EXPECT_NEAR(pose(*simulation, 0).origin()[2], kRadius, 1e-12);
  EXPECT_NEAR(simulation->efforts()[0], 2.0 * kGravity, 1e-7);
}

// States saved in flight, between rebounds, and at rest.
TEST(EventDriven, StatesGoOnBitForBit) {
  const int pauses[] = {5, 40, 200, 100};
  expect_same_run(*ball(20e-3, 0.9, 0.2), pauses, 30, 2);
}

}  // namespace
}  // namespace sinew::testing
