#include "samples.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace carom::io {
namespace {

using std::numbers::pi;

class Random {
  public:
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1p-53;
    }

  private:
    std::mt19937_64 generator_{7};
};

/// One ball of the toy world; the body that it carries may look like anything.
struct Particle {
    ReplayVector position{}, velocity{}, angular_velocity{};
    ReplayRotation rotation{0, 0, 0, 1};
    double radius = 0.5;
    int still = 0;    ///< frames for which it has hardly moved
    int appears = 0;  ///< frame
    int vanishes = 1 << 30;
    std::int32_t body = 0;
};

struct Toy {
    Replay replay;
    std::vector<Particle> particles;
    double half_width = 8;  ///< of the box into which they fall
    Random random;

    explicit Toy(int dimension) {
        replay.dimension = dimension;
        replay.gravity = {0, -9.81, 0};
    }
    bool flat() const { return replay.dimension == 2; }

    void add_fixed(const std::string& name, ReplayShape shape) {
        ReplayBody body;
        body.name = name;
        body.type = ReplayBodyType::fixed;
        body.shapes = {std::move(shape)};
        replay.bodies.push_back(std::move(body));
    }

    Particle& add(const std::string& name, ReplayVector position, double radius,
                  std::vector<ReplayShape> shapes) {
        ReplayBody body;
        body.name = name;
        body.mass = flat() ? 600 * pi * radius * radius : 600 * 4.19 * radius * radius * radius;
        const double inertia = 0.4 * body.mass * radius * radius;
        body.inertia = {inertia, inertia, inertia, 0, 0, 0};
        body.shapes = std::move(shapes);
        Particle particle;
        particle.position = position;
        particle.radius = radius;
        particle.body = static_cast<std::int32_t>(replay.bodies.size());
        for (int i = 0; i < 3; ++i)
            particle.angular_velocity[i] = flat() && i < 2 ? 0 : random.between(-3, 3);
        replay.bodies.push_back(std::move(body));
        particles.push_back(particle);
        return particles.back();
    }

    std::vector<ReplayContact> substep(double h);
    std::vector<ReplayContact> collide();
    void record(int frame, std::vector<ReplayContact> contacts);
    void run(int frames);
};

void turn(ReplayRotation& q, const ReplayVector& w, double h) {
    const auto [x, y, z, s] = q;
    const double a = w[0] * h / 2, b = w[1] * h / 2, c = w[2] * h / 2;
    q = {x + a * s + b * z - c * y, y + b * s + c * x - a * z, z + c * s + a * y - b * x,
         s - a * x - b * y - c * z};
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& component : q) component /= length;
}

/// Pushes `p` out along `normal` (towards `p`) and lets it roll off; `share` is its part of the way.
double push(Particle& p, const ReplayVector& normal, double depth, double share, double approach) {
    for (int i = 0; i < 3; ++i) {
        p.position[i] += normal[i] * depth * share;
        p.velocity[i] -= 1.25 * normal[i] * std::min(approach, 0.0) * share;
    }
    ReplayVector rolling{normal[1] * p.velocity[2] - normal[2] * p.velocity[1],
                         normal[2] * p.velocity[0] - normal[0] * p.velocity[2],
                         normal[0] * p.velocity[1] - normal[1] * p.velocity[0]};
    for (int i = 0; i < 3; ++i) {
        p.angular_velocity[i] += 0.1 * (rolling[i] / p.radius - p.angular_velocity[i]);
        p.velocity[i] *= 0.998;
    }
    return -approach;
}

std::vector<ReplayContact> Toy::collide() {
    std::vector<ReplayContact> contacts;
    const auto mass = [&](const Particle& p) { return replay.bodies[p.body].mass; };
    const auto walls = [&](Particle& p) {
        const ReplayVector normals[] = {{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
        const double offsets[] = {0, -half_width, -half_width, -half_width, -half_width};
        for (int k = 0; k < (flat() ? 3 : 5); ++k) {
            const ReplayVector& n = normals[k];
            double height = -offsets[k] - p.radius, approach = 0;
            for (int i = 0; i < 3; ++i) {
                height += n[i] * p.position[i];
                approach += n[i] * p.velocity[i];
            }
            if (height > 0) continue;
            const double impulse = mass(p) * push(p, n, -height, 1, approach);
            ReplayContact contact{0, p.body, p.position, {}, static_cast<float>(std::max(impulse, 0.0))};
            for (int i = 0; i < 3; ++i) {
                contact.position[i] -= n[i] * p.radius;
                contact.normal[i] = static_cast<float>(n[i]);
            }
            contacts.push_back(contact);
        }
    };
    const auto meet = [&](Particle& p, Particle& q) {
        ReplayVector n{};
        double distance = 0, approach = 0;
        for (int i = 0; i < 3; ++i) {
            n[i] = q.position[i] - p.position[i];
            distance += n[i] * n[i];
        }
        distance = std::sqrt(distance);
        if (distance >= p.radius + q.radius || distance == 0) return;
        for (int i = 0; i < 3; ++i) {
            n[i] /= distance;
            approach += n[i] * (q.velocity[i] - p.velocity[i]);
        }
        const double depth = p.radius + q.radius - distance, share = mass(p) / (mass(p) + mass(q));
        ReplayContact contact{p.body, q.body, p.position, {}, 0};
        for (int i = 0; i < 3; ++i) {
            contact.position[i] += n[i] * p.radius;
            contact.normal[i] = static_cast<float>(n[i]);
        }
        push(q, n, depth, share, approach);
        const double speed = push(p, {-n[0], -n[1], -n[2]}, depth, 1 - share, approach);
        contact.impulse = static_cast<float>(std::max(0.0, speed * mass(p) * (1 - share)));
        contacts.push_back(contact);
    };
    std::vector<std::size_t> order(particles.size());  // along x: only near ones can meet
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
        return particles[i].position[0] < particles[j].position[0];
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        Particle& p = particles[order[i]];
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            Particle& q = particles[order[j]];
            if (q.position[0] - p.position[0] > 1.1) break;
            meet(p, q);
        }
        walls(p);
    }
    return contacts;
}

std::vector<ReplayContact> Toy::substep(double h) {
    for (Particle& p : particles) {
        p.velocity[1] += replay.gravity[1] * h;
        for (int i = 0; i < 3; ++i) p.position[i] += p.velocity[i] * h;
        turn(p.rotation, p.angular_velocity, h);
    }
    return collide();
}

void Toy::record(int frame, std::vector<ReplayContact> contacts) {
    ReplayFrame recorded;
    recorded.states.resize(replay.bodies.size());
    for (std::size_t b = 0; b < replay.bodies.size(); ++b)
        recorded.states[b].present = replay.bodies[b].type == ReplayBodyType::fixed;
    for (Particle& p : particles) {
        const double mass = replay.bodies[p.body].mass;
        ReplayState& state = recorded.states[p.body];
        state.present = frame >= p.appears && frame < p.vanishes;
        state.position = p.position;
        double speed = 0;
        for (int i = 0; i < 3; ++i) {
            state.velocity[i] = static_cast<float>(p.velocity[i]);
            state.angular_velocity[i] = static_cast<float>(p.angular_velocity[i]);
            speed += p.velocity[i] * p.velocity[i];
            recorded.kinetic += replay.bodies[p.body].inertia[i] * std::pow(p.angular_velocity[i], 2) / 2;
        }
        for (int i = 0; i < 4; ++i) state.rotation[i] = static_cast<float>(p.rotation[i]);
        recorded.kinetic += mass * speed / 2;
        recorded.potential += mass * 9.81 * p.position[1];
        p.still = speed < 0.3 ? p.still + 1 : 0;
        state.awake = p.still < 30;
        if (p.still > 30) {  // asleep: it stands still
            p.velocity = p.angular_velocity = {};
            state.velocity = state.angular_velocity = {};
        }
    }
    recorded.contacts = std::move(contacts);
    replay.frames.push_back(std::move(recorded));
}

void Toy::run(int frames) {
    std::vector<ReplayContact> contacts;
    for (int frame = 0; frame < frames; ++frame) {
        record(frame, std::move(contacts));
        for (int k = 0; k < 4; ++k) contacts = substep(replay.step / 4);
    }
}

ReplayShape shape(ReplayGeometry geometry, const std::string& material, ReplayVector center = {},
                  ReplayRotation rotation = {0, 0, 0, 1}) {
    return {std::move(geometry), center, rotation, material};
}

ReplayHull polygon(int corners, double radius) {
    ReplayHull hull;
    for (int i = 0; i < corners; ++i)
        hull.points.push_back(
            {radius * std::cos(2 * pi * i / corners), radius * std::sin(2 * pi * i / corners), 0});
    return hull;
}

/// A prism over a regular polygon, its lower end wider: a rock, a wedge, a gem.
ReplayHull prism(std::uint32_t corners, double lower, double upper, double height) {
    ReplayHull hull;
    std::vector<std::uint32_t> bottom, top;
    for (std::uint32_t i = 0; i < corners; ++i) {
        const double angle = 2 * pi * i / corners;
        hull.points.push_back({lower * std::cos(angle), -height / 2, lower * std::sin(angle)});
        hull.points.push_back({upper * std::cos(angle), height / 2, upper * std::sin(angle)});
        bottom.push_back(2 * i);
        top.insert(top.begin(), 2 * i + 1);
        const std::uint32_t next = (i + 1) % corners;
        hull.faces.push_back({2 * i, 2 * i + 1, 2 * next + 1, 2 * next});
    }
    hull.faces.push_back(bottom);
    hull.faces.push_back(top);
    return hull;
}

void fill_2d(Toy& toy) {
    toy.add_fixed("ground", shape(ReplayBox{{60, 1, 0}}, "stone", {0, -0.5, 0}));
    toy.add_fixed("left wall", shape(ReplayBox{{0.5, 4, 0}, 0.1}, "stone", {-8.25, 2, 0}));
    toy.add_fixed("right wall", shape(ReplayBox{{0.5, 4, 0}, 0.1}, "stone", {8.25, 2, 0}));
    toy.add_fixed("deep ground", shape(ReplayPlane{{0, 1, 0}, -1}, "soil"));
    const double r = 0.5;
    const std::vector<std::vector<ReplayShape>> kinds = {
        {shape(ReplayBall{r}, "rubber")},
        {shape(ReplayBox{{0.9, 0.9, 0}}, "wood")},
        {shape(ReplayBox{{1.1, 0.7, 0}, 0.15}, "ice")},
        {shape(ReplayCapsule{{-0.3, 0, 0}, {0.3, 0, 0}, 0.25}, "metal")},
        {shape(polygon(3, 0.6), "glass")},
        {shape(polygon(6, r), "stone")},
        {shape(ReplayBox{{1, 0.25, 0}}, "wood"), shape(ReplayBox{{0.25, 1, 0}}, "metal")},
        {shape(ReplayBall{r}, "")},
    };
    for (int i = 0; i < 40; ++i) {
        const auto& kind = kinds[static_cast<std::size_t>(i) % kinds.size()];
        const ReplayVector place{-6 + 1.6 * (i % 8) + toy.random.between(-0.3, 0.3), 2.0 + 1.5 * (i / 8), 0};
        toy.add(kind.front().material + " " + std::to_string(i), place, r, kind);
    }
}

void fill_3d(Toy& toy) {
    toy.half_width = 4;
    toy.add_fixed("ground", shape(ReplayBox{{40, 1, 40}}, "stone", {0, -0.5, 0}));
    toy.add_fixed("wall", shape(ReplayBox{{0.4, 1, 8.8}}, "stone", {-4.2, 0.5, 0}));
    toy.add_fixed("wall 2", shape(ReplayBox{{8, 1, 0.4}, 0.05}, "stone", {0, 0.5, -4.2}));
    toy.add_fixed("deep ground", shape(ReplayPlane{{0, 1, 0}, -1}, "soil"));
    const double r = 0.5;
    ReplayHull smooth = prism(5, 0.35, 0.3, 0.5);
    smooth.rounding = 0.12;
    const std::vector<std::vector<ReplayShape>> kinds = {
        {shape(ReplayBall{r}, "rubber")},
        {shape(ReplayBox{{0.8, 0.8, 0.8}}, "wood")},
        {shape(ReplayBox{{0.9, 0.6, 0.7}, 0.12}, "ice")},
        {shape(ReplayCapsule{{-0.3, 0, 0}, {0.3, 0, 0}, 0.25}, "metal")},
        {shape(ReplayCylinder{0.4, 0.8}, "steel")},
        {shape(ReplayCone{0.45, 0.9}, "plastic")},
        {shape(prism(6, 0.5, 0.3, 0.7), "stone")},
        {shape(smooth, "glass")},
        {shape(ReplayBall{0.3}, "metal", {-0.45, 0, 0}), shape(ReplayBall{0.3}, "metal", {0.45, 0, 0}),
         shape(ReplayCylinder{0.1, 0.9}, "wood", {}, replay_rotation(pi / 2))},
        {shape(prism(4, 0.5, 0.001, 0.8), "")},
    };
    for (int i = 0; i < 60; ++i) {
        const auto& kind = kinds[static_cast<std::size_t>(i) % kinds.size()];
        const ReplayVector place{-3 + 1.5 * (i % 5), 2 + 1.2 * (i / 20),
                                 -2.5 + 1.5 * (i / 5 % 4) + toy.random.between(-0.2, 0.2)};
        toy.add(kind.front().material + " " + std::to_string(i), place, r, kind);
    }
}

/// What every sample has besides its shapes: bodies that come and go, a driven one, springs, hard names.
void add_specials(Toy& toy) {
    toy.particles[3].appears = 60;
    toy.particles[5].vanishes = 150;
    toy.replay.bodies[toy.particles[0].body].name = "ball </script><b>\"é\" \xff";
    ReplayBody lift;
    lift.name = "lift";
    lift.type = ReplayBodyType::kinematic;
    lift.shapes = {shape(ReplayBox{{2, 0.3, 2}}, "metal"), shape(ReplayBall{0.8}, "light", {0, 1, 0}),
                   shape(ReplayBox{{2, 0.2, 2}}, "wood", {0, 2, 0})};
    lift.shapes[0].surface_velocity = {0.5, 0, 0};
    lift.shapes[1].sensor = true;
    lift.shapes[2].one_way = ReplayVector{0, 1, 0};
    const auto index = static_cast<std::int32_t>(toy.replay.bodies.size());
    toy.replay.bodies.push_back(lift);
    toy.replay.links.push_back({"spring", index, toy.particles[1].body, {0, 0.15, 0}, {}});
    toy.replay.links.push_back({"spring", -1, index, {0, 10, 0}, {0, 0.15, 0}});
}

void move_lift(Replay& replay) {
    const std::size_t lift = replay.bodies.size() - 1;
    for (std::size_t f = 0; f < replay.frames.size(); ++f) {
        ReplayState& state = replay.frames[f].states[lift];
        const double time = static_cast<double>(f) * replay.step;
        state.present = true;
        state.sensing = f % 100 >= 50;
        state.position = {0, 7 + std::sin(time), 0};
        state.velocity = {0, static_cast<float>(std::cos(time)), 0};
    }
}

}  // namespace

Replay sample_replay(int dimension) {
    Toy toy(dimension);
    toy.replay.name = dimension == 2 ? "Toy box in the plane" : "Toy box in space";
    if (toy.flat())
        fill_2d(toy);
    else
        fill_3d(toy);
    add_specials(toy);
    toy.run(300);
    move_lift(toy.replay);
    return std::move(toy.replay);
}

Replay large_sample_replay(int dimension) {
    Toy toy(dimension);
    toy.replay.name = dimension == 2 ? "A thousand bodies in the plane" : "A thousand bodies in space";
    toy.half_width = dimension == 2 ? 20 : 6;
    toy.add_fixed("ground", shape(ReplayBox{{200, 1, 200}}, "stone", {0, -0.5, 0}));
    const int across = dimension == 2 ? 40 : 10;
    for (int i = 0; i < 1000; ++i) {
        const int row = dimension == 2 ? i / across : i / (across * across);
        const double x = dimension == 2 ? -19.5 + (i % across) : -5 + 1.1 * (i % across);
        const double z = dimension == 2 ? 0 : -5 + 1.1 * (i / across % across);
        const double size = toy.random.between(0.25, 0.5);
        std::vector<ReplayShape> shapes;
        switch (i % 4) {
            case 0:
                shapes = {shape(ReplayBall{size}, "rubber")};
                break;
            case 1:
                shapes = {shape(ReplayBox{{1.6 * size, 1.6 * size, 1.6 * size}}, "wood")};
                break;
            case 2:
                shapes = {shape(ReplayCapsule{{0, -size / 2, 0}, {0, size / 2, 0}, size / 2}, "metal")};
                break;
            default:
                shapes = {
                    shape(dimension == 2 ? polygon(5, size) : prism(5, size, size * 0.7, size), "stone")};
        }
        Particle& p = toy.add("body " + std::to_string(i), {x, 1 + 1.2 * row, z}, size, std::move(shapes));
        for (int k = 0; k < dimension; ++k) p.velocity[k] = toy.random.between(-4, 4);
    }
    toy.run(600);
    return std::move(toy.replay);
}

}  // namespace carom::io
