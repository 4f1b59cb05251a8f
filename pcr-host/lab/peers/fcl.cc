// Proximity of meshes at every sample of time by FCL, which goes on where the library PQP of the paper ended: cylinders of
// triangles in trees of boxes, with boxes around the discs in front.
//   input   sides of a cylinder, its height, and how much higher the second one of a pair stands; number of agents and of
//           samples; of each agent the radius of its cylinder, and of each of its samples x, y
//   output  runs of samples at which two agents touch: numbers of the first and the last one
#include <fcl/fcl.h>

#include <memory>

#include "peer.h"

namespace {

using Mesh = fcl::BVHModel<fcl::OBBRSSd>;

struct Agent {
  double radius;
  std::vector<fcl::Vector3d> at;
};

std::shared_ptr<Mesh> cylinder(std::size_t sides, double radius, double height) {
  const double turn = 2.0 * std::acos(-1.0);
  std::vector<fcl::Vector3d> corners;
  for (const double z : {0.0, height}) {
    for (std::size_t k = 0; k < sides; ++k) {
      const double angle = turn * static_cast<double>(k) / static_cast<double>(sides);
      corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  std::vector<fcl::Triangle> faces;
  for (std::size_t k = 0; k < sides; ++k) {
    const std::size_t next = (k + 1) % sides;
    faces.emplace_back(k, next, sides + next);
    faces.emplace_back(k, sides + next, sides + k);
  }
  for (std::size_t k = 1; k + 1 < sides; ++k) {
    faces.emplace_back(0, k + 1, k);
    faces.emplace_back(sides, sides + k, sides + k + 1);
  }
  auto mesh = std::make_shared<Mesh>();
  mesh->beginModel();
  mesh->addSubModel(corners, faces);
  mesh->endModel();
  return mesh;
}

}  // namespace

int main() {
  const std::size_t sides = peer::count();
  const double height = peer::number(), up = peer::number();
  std::vector<Agent> agents(peer::count());
  const std::size_t samples = peer::count();
  for (Agent& agent : agents) {
    agent.radius = peer::number();
    agent.at.resize(samples);
    for (fcl::Vector3d& at : agent.at) {
      at[0] = peer::number();
      at[1] = peer::number();
      at[2] = 0.0;
    }
  }
  peer::report([&] {
    std::vector<std::shared_ptr<Mesh>> meshes;
    for (const Agent& agent : agents) meshes.push_back(cylinder(sides, agent.radius, height));
    const fcl::CollisionRequestd request;
    const fcl::Vector3d above(0.0, 0.0, up);
    std::vector<peer::Contact> contacts;
    for (std::size_t first = 0; first < agents.size(); ++first) {
      for (std::size_t second = first + 1; second < agents.size(); ++second) {
        const Agent &a = agents[first], &b = agents[second];
        const double reach = a.radius + b.radius;
        bool open = false;
        for (std::size_t k = 0; k < samples; ++k) {
          const fcl::Vector3d way = b.at[k] - a.at[k];
          bool touch = std::abs(way[0]) <= reach && std::abs(way[1]) <= reach;
          if (touch) {
            const fcl::Transform3d own(fcl::Translation3d(a.at[k])), other(fcl::Translation3d(b.at[k] + above));
            fcl::CollisionResultd result;
            touch = fcl::collide(meshes[first].get(), own, meshes[second].get(), other, request, result) > 0;
          }
          const double sample = static_cast<double>(k);
          if (touch && open) {
            contacts.back().end = sample;
          } else if (touch) {
            contacts.push_back({first, second, sample, sample});
          }
          open = touch;
        }
      }
    }
    return contacts;
  });
}
