#include "engine/dynamics/contact_order.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/core/random.h"
#include "tests/engine/dynamics/bodies.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

// Bodies of which the first is held, and contacts of pairs that are drawn, some in several stretches.
MotionWork draw_work(int bodies, int contacts, bool all_with_one) {
  MotionWork work;
  work.bodies.resize(at(bodies));
  core::Random random(7);
  for (int i = 1; i < bodies; ++i) {
    work.bodies[at(i)].inverse_mass = 1.0;
    work.bodies[at(i)].start.translation =
        Vec3(random.uniform(0, 1), random.uniform(0, 3), random.uniform(0, 2));
  }
  const auto draw = [&](int most) {
    return std::min(most - 1, static_cast<int>(random.uniform(0, static_cast<double>(most))));
  };
  for (int i = 0; i < contacts; ++i) {
    SolverContact c;
    c.a = all_with_one ? 1 : draw(bodies - 1);
    c.b = all_with_one ? 2 + i % (bodies - 2) : c.a + 1 + draw(bodies - 1 - c.a);
    c.pair = c.a * bodies + c.b;
    work.contacts.push_back(c);
  }
  std::stable_sort(work.contacts.begin(), work.contacts.end() - contacts / 20,
                   [](const SolverContact& x, const SolverContact& y) { return x.pair < y.pair; });
  return work;
}

Island island_of(const MotionWork& work) {
  Island island;
  for (std::size_t i = 0; i < work.contacts.size(); ++i) island.contacts.push_back(static_cast<int>(i));
  for (std::size_t i = 0; i < work.bodies.size(); ++i)
    if (work.bodies[i].inverse_mass > 0.0) island.bodies.push_back(static_cast<int>(i));
  return island;
}

void check_order(const MotionWork& work, const ContactOrder& order) {
  std::vector<int> sorted = order.contacts;
  std::sort(sorted.begin(), sorted.end());
  CHECK(sorted == island_of(work).contacts);
  // From the smallest parts up to the whole they follow each other.
  std::size_t next_contact = 0;
  std::set<int> pairs_seen;
  std::vector<std::set<int>> moved(order.parts.size());
  for (std::size_t first = order.count_smallest(); first > 0; first /= 2) {
    for (std::size_t part = first; part < 2 * first; ++part) {
      CHECK(order.parts[part].begin == next_contact);
      next_contact = order.parts[part].end;
      std::set<int> pairs;
      for (std::size_t i = order.parts[part].begin; i < order.parts[part].end; ++i) {
        const SolverContact& c = work.contacts[at(order.contacts[i])];
        pairs.insert(c.pair);
        for (const int b : {c.a, c.b})
          if (work.bodies[at(b)].inverse_mass > 0.0) moved[part].insert(b);
      }
      for (const int pair : pairs) CHECK(pairs_seen.insert(pair).second);
    }
  }
  CHECK(next_contact == order.contacts.size());
  // What is moved in one half of a part is not in the other.
  for (std::size_t part = order.parts.size() - 1; part > 1; --part) {
    if (part % 2 == 0) {
      for (const int b : moved[part]) CHECK_FALSE(moved[part + 1].contains(b));
    }
    moved[part / 2].insert(moved[part].begin(), moved[part].end());
  }
  std::size_t next_slice = 0;
  std::set<int> pairs_sliced;
  for (const ContactOrder::Range& slice : order.slices) {
    CHECK(slice.begin == next_slice);
    next_slice = slice.end;
    std::set<int> pairs;
    for (std::size_t i = slice.begin; i < slice.end; ++i)
      pairs.insert(work.contacts[at(order.contacts[i])].pair);
    for (const int pair : pairs) CHECK(pairs_sliced.insert(pair).second);
  }
  CHECK(next_slice == order.contacts.size());
  std::vector<int> bodies = order.bodies;
  std::sort(bodies.begin(), bodies.end());
  CHECK(bodies == island_of(work).bodies);
}

// Balls in a heap, each in touch with those about it; numbers tell nothing of places.
MotionWork draw_heap(int bodies) {
  MotionWork work;
  work.bodies.resize(at(bodies));
  core::Random random(3);
  for (WorkBody& body : work.bodies) {
    body.inverse_mass = 1.0;
    body.start.translation = Vec3(random.uniform(0, 12), random.uniform(0, 4), random.uniform(0, 8));
  }
  for (int a = 0; a < bodies; ++a) {
    for (int b = a + 1; b < bodies; ++b) {
      if ((work.bodies[at(a)].start.translation - work.bodies[at(b)].start.translation).norm() > 1.0)
        continue;
      SolverContact c;
      c.a = a;
      c.b = b;
      c.pair = static_cast<int>(work.contacts.size());
      work.contacts.push_back(c);
    }
  }
  return work;
}

}  // namespace

TEST_CASE("contacts that are visited at once share no body that moves, and no pair") {
  const MotionWork work = draw_work(300, 3000, false);
  const ContactOrder order = order_contacts(island_of(work), work);
  check_order(work, order);
  CHECK(order.slices.size() > 100);
}

TEST_CASE("most of a heap is visited at once") {
  const MotionWork work = draw_heap(1000);
  const ContactOrder order = order_contacts(island_of(work), work);
  check_order(work, order);
  CHECK(work.contacts.size() > 4000);
  // What no number of threads could make shorter: from a smallest part to the whole.
  const auto size = [&](std::size_t part) { return order.parts[part].end - order.parts[part].begin; };
  std::vector<std::size_t> in_turn(order.parts.size(), 0);
  for (std::size_t part = order.parts.size() - 1; part > 0; --part) {
    const std::size_t half = 2 * part;
    in_turn[part] = size(part);
    if (half < in_turn.size()) in_turn[part] += std::max(in_turn[half], in_turn[half + 1]);
  }
  CHECK(in_turn[1] < work.contacts.size() / 3);
  CHECK(order.count_smallest() >= 32);
}

TEST_CASE("the neighbours of one body are visited one by one") {
  const MotionWork work = draw_work(1500, 2000, true);
  const ContactOrder order = order_contacts(island_of(work), work);
  check_order(work, order);
  // All that are across the parts that the one is in, from the whole down to the smallest.
  std::size_t apart = 0;
  for (std::size_t part = 1; part < order.parts.size(); ++part)
    apart += order.parts[part].begin < order.parts[part].end ? 1 : 0;
  std::size_t levels = 1;
  while (order.parts.size() >> (levels + 1) > 0) ++levels;
  CHECK(apart <= levels);
}

TEST_CASE("the contacts of a small island keep their order") {
  const MotionWork work = draw_work(50, static_cast<int>(Island::kLarge), false);
  const ContactOrder order = order_contacts(island_of(work), work);
  CHECK(order.contacts == island_of(work).contacts);
  CHECK(order.count_smallest() == 1);
  CHECK(order.parts[1].end == order.contacts.size());
}

TEST_CASE("a heap that is one island has the same bits on any number of threads") {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 5}) {
    core::set_thread_count(threads);
    test::Scene scene;
    scene.add(test::make_plane());
    for (int i = 0; i < 500; ++i) {
      const int layer = i / 100, row = i / 10 % 10;
      const Vec3 place(0.2002 * (i % 10), 0.1 + 1e-4 + 0.2003 * layer, 0.2002 * row);
      scene.add(test::make_box(Vec3::Constant(0.1), place));
      scene.bodies.back().velocity = Vec3(0.1 * (i % 3), -0.5, 0.05 * (i % 7));
    }
    int most = 0;
    for (int i = 0; i < 20; ++i) {
      scene.step();
      most = std::max(most, scene.report.solver_contacts);
    }
    CHECK(most > 2 * static_cast<int>(Island::kLarge));
    hashes.push_back(scene.hash());
  }
  core::set_thread_count(0);
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

}  // namespace shatterbox::dynamics
