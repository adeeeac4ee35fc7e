#include <algorithm>
#include <array>

#include "core/crew.hpp"
#include "core/room.hpp"
#include "math/check.hpp"
#include "world/state.hpp"
#include "world/validate.hpp"

// How bodies and shapes come into a world, and how shapes change. Everything is checked before anything is
// changed.

namespace carom {

using namespace detail;

namespace {

/// Lets there be the lists' elements for that many bodies from now on.
template <int D>
void lengthen_for_bodies(WorldState<D>& w, std::size_t count) {
    w.applied.resize(count);
    w.tree_of.resize(count);
    w.moving.resize(count);
    w.place.resize(count);
    w.loads.resize(count);
    w.varies.resize(count);
    w.fixed_contacts_of.resize(count);
}

template <int D>
std::uint32_t new_body_place(WorldState<D>& w) {
    const std::uint32_t i = w.body_slots.acquire();
    if (i == w.states.size()) {
        w.states.emplace_back();
        w.masses.emplace_back();
        w.types.emplace_back();
        w.infos.emplace_back();
        w.only_shape.emplace_back();
        lengthen_for_bodies(w, i + 1);
    } else {
        w.states[i] = {};
        w.masses[i] = {};
        w.infos[i] = {};
        w.applied[i] = {};
    }
    w.only_shape[i] = w.no_shape;
    return i;
}

/// Room for so many more bodies, and shapes on them, where these are many.
template <int D>
void make_room_for(WorldState<D>& w, std::size_t bodies, std::size_t shapes) {
    constexpr std::size_t many = 64;
    if (bodies + shapes < many) return;
    const auto make = [](std::size_t more, auto&... lists) { (make_room(lists, more), ...); };
    make(bodies, w.states, w.masses, w.types, w.only_shape, w.infos, w.applied, w.tree_of, w.moving, w.place,
         w.loads, w.varies, w.fixed_contacts_of, w.body_ids);
    make(shapes, w.shapes, w.company, w.extents, w.fat_boxes, w.has_new_box, w.unplanted, w.moved_shapes);
}

/// As long as none of these has come to the other side of a wall, nothing has passed through.
template <int D>
Shape<D> core_of(const Shape<D>& shape) {
    if (shape.kind == ShapeKind::plane || shape.kind == ShapeKind::terrain) return {};
    Shape<D> ball = inner_ball(shape);
    ball.radius *= 0.5;
    return ball;
}

template <int D>
using Model = std::shared_ptr<const ShapeModel<D>>;

template <int D>
Model<D> model_of(const ShapeDefinition<D>& definition, Shape<D> shape) {
    const Shape<D> core = core_of(shape);
    auto model = std::make_shared<ShapeModel<D>>();
    model->shape = std::move(shape);
    model->definition = definition;
    model->core = core.a;
    model->core_radius = core.radius;
    return model;
}

template <int D>
Company company_of(const ShapeModel<D>& model, std::uint32_t body) {
    const ShapeDefinition<D>& s = model.definition;
    return {s.filter.category, s.filter.mask, body,
            s.filter.group,    s.sensor,      model.shape.kind == ShapeKind::terrain};
}

template <int D>
void set_model(WorldState<D>& w, std::uint32_t i, std::uint32_t body, const Model<D>& model) {
    w.shapes[i] = {model, body};
    w.company[i] = company_of(*model, body);
}

template <int D>
ShapeId<D> put_shape(WorldState<D>& w, std::uint32_t body, const Model<D>& model) {
    const std::uint32_t i = w.shape_slots.acquire();
    if (i == w.shapes.size()) {
        w.shapes.emplace_back();
        w.company.emplace_back();
        w.extents.emplace_back();
        w.fat_boxes.emplace_back();
        w.has_new_box.push_back(0);
        w.contact_links.make_room(WorldState<D>::contact_list(i + 1, false));
    }
    set_model(w, i, body, model);
    const auto id = w.shape_slots.template id<ShapeId<D>>(i);
    w.infos[body].shapes.push_back(id);
    return id;
}

template <int D>
void drop_shape(WorldState<D>& w, ShapeId<D> id) {
    w.remove_contacts_of_shape(id.index);
    w.remove_visits_of(id.index);
    w.remove_leaf(id.index);
    w.lane_shapes.forget(id.index);
    w.shape_slots.release(id.index);
}

}  // namespace

namespace detail {

template <int D>
bool Blueprint<D>::serves(const BodyDefinition<D>& b) const {
    const auto same_shape = [](const ShapeDefinition<D>& wanted, const Model<D>& one) {
        return wanted == one->definition;
    };
    return made && b.type == definition.type && b.mass == definition.mass &&
           b.center_of_mass == definition.center_of_mass && b.inertia == definition.inertia &&
           b.gravity_scale == definition.gravity_scale && b.linear_damping == definition.linear_damping &&
           b.angular_damping == definition.angular_damping && b.locks == definition.locks &&
           std::ranges::equal(b.shapes, shapes, same_shape);
}

}  // namespace detail

namespace {

/// Works out what bodies like this one have in common; the body that is added stands at `i`.
template <int D>
void draw_blueprint(WorldState<D>& w, const BodyDefinition<D>& definition, std::vector<Shape<D>> shapes) {
    Blueprint<D>& plan = w.blueprint;
    plan.made = true;
    plan.definition = {};
    plan.definition.type = definition.type;
    plan.definition.mass = definition.mass;
    plan.definition.center_of_mass = definition.center_of_mass;
    plan.definition.inertia = definition.inertia;
    plan.definition.gravity_scale = definition.gravity_scale;
    plan.definition.linear_damping = definition.linear_damping;
    plan.definition.angular_damping = definition.angular_damping;
    plan.definition.locks = definition.locks;
    plan.shapes.clear();
    for (std::size_t k = 0; k < shapes.size(); ++k)
        plan.shapes.push_back(model_of(definition.shapes[k], std::move(shapes[k])));
    plan.mass = {};
    plan.mass.gravity_scale = definition.gravity_scale;
    plan.mass.linear_damping = definition.linear_damping;
    plan.mass.angular_damping = definition.angular_damping;
    plan.mass.locks = definition.locks;
}

/// Where the body is whose frame is at `placed`.
template <int D>
BodyState<D> state_at(const Transform<D>& placed, const Vec<D>& center) {
    BodyState<D> s;
    s.rotation = normalized(placed.rotation);
    s.position = placed.position + rotate(s.rotation, center);
    return s;
}

template <int D>
BodyInfo<D> info_of(const BodyDefinition<D>& definition) {
    BodyInfo<D> info;
    info.can_sleep = definition.can_sleep;
    info.bullet = definition.bullet;
    info.user_data = definition.user_data;
    if (!definition.name.empty()) info.own().name = definition.name;
    if (definition.mass || definition.center_of_mass || definition.inertia)
        info.own().overrides = overrides_of(definition);
    return info;
}

/// Puts a body into the world that the blueprint serves, at `placed`; the first of its kind says what mass it
/// has.
template <int D>
BodyId<D> put_body(WorldState<D>& w, const BodyDefinition<D>& definition, const Transform<D>& placed,
                   bool is_first) {
    Blueprint<D>& plan = w.blueprint;
    const std::uint32_t i = new_body_place(w);
    w.types[i] = definition.type;
    w.bullets += definition.bullet;
    w.infos[i] = info_of(definition);
    for (const Model<D>& model : plan.shapes) put_shape(w, i, model);
    BodyState<D>& s = w.states[i];
    BodyMass<D>& m = w.masses[i];
    m = plan.mass;
    s = state_at(placed, m.center);
    if (is_first) {
        w.update_mass(i);  // moves the place from the frame to the centre of mass
        plan.mass = m;
    } else {
        w.measure_extents(i);
    }
    w.some_locked |= definition.locks != Locks{};
    if (definition.type != BodyType::fixed) {
        s.velocity = free_components<D>(m.locks, definition.velocity);
        s.angular_velocity = free_spin<D>(m.locks, definition.angular_velocity);
        w.movable.push_back(i);
        w.roused.push_back(i);
    }
    w.tree_of[i] = w.tree_for(i);
    for (const ShapeId<D>& shape : w.infos[i].shapes) w.insert_leaf(shape.index);
    const auto id = w.body_slots.template id<BodyId<D>>(i);
    w.body_ids.push_back(id);
    return id;
}

/// Bodies like one that was just put into the world, in places of the lists that nobody had before: each list
/// is written from end to end, and several at a time where there are workers.
template <int D>
class Copies {
  public:
    Copies(WorldState<D>& w, const BodyDefinition<D>& definition, BodyId<D> like,
           std::span<const Transform<D>> places)
        : w_(w),
          definition_(definition),
          like_(like.index),
          mass_(w.masses[like.index]),
          models_(w.blueprint.shapes),
          places_(places) {}

    void put(std::vector<BodyId<D>>& added) {
        first_ = w_.body_slots.acquire_new(places_.size());
        first_shape_ = w_.shape_slots.acquire_new(shape_count());
        const std::array<void (Copies::*)(), 4> lists{&Copies::put_masses, &Copies::put_infos,
                                                      &Copies::put_shapes, &Copies::put_places};
        constexpr std::size_t worth_workers = 1000;
        Scheduler* const workers = places_.size() < worth_workers ? nullptr : w_.scheduler.get();
        run_range(workers, lists.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) (this->*lists[i])();
        });
        added.insert(added.end(), w_.body_ids.end() - static_cast<std::ptrdiff_t>(places_.size()),
                     w_.body_ids.end());
        if (shape_count() > 0) w_.some_unplanted.store(true, std::memory_order_relaxed);
        w_.bullets += static_cast<std::uint32_t>(definition_.bullet * places_.size());
        if (definition_.type != BodyType::fixed) put_movable();
    }

  private:
    std::size_t shape_count() const { return places_.size() * models_.size(); }
    std::uint32_t body(std::size_t k) const { return first_ + static_cast<std::uint32_t>(k); }
    std::uint32_t shape(std::size_t k) const {
        return first_shape_ + static_cast<std::uint32_t>(k * models_.size());
    }

    void put_masses() {
        w_.masses.resize(w_.masses.size() + places_.size(), mass_);
        w_.types.resize(w_.types.size() + places_.size(), definition_.type);
        lengthen_for_bodies(w_, w_.types.size());
        if (w_.tree_of[like_] != of_fixed)
            std::fill(w_.tree_of.begin() + first_, w_.tree_of.end(), TreeKind(w_.tree_of[like_]));
    }

    void put_infos() {
        for (std::size_t k = 0; k < places_.size(); ++k) {
            w_.body_ids.push_back(w_.body_slots.template id<BodyId<D>>(body(k)));
            w_.only_shape.push_back(models_.size() == 1 ? shape(k) : w_.no_shape);
            BodyInfo<D>& info = w_.infos.emplace_back(info_of(definition_));
            for (std::uint32_t j = 0; j < models_.size(); ++j)
                info.shapes.push_back(w_.shape_slots.template id<ShapeId<D>>(shape(k) + j));
        }
    }

    void put_shapes() {
        std::vector<Company> company;
        for (const Model<D>& model : models_) company.push_back(company_of(*model, 0));
        for (std::size_t k = 0; k < places_.size(); ++k) {
            for (std::uint32_t j = 0; j < models_.size(); ++j) {
                w_.shapes.push_back({models_[j], body(k)});
                w_.company.push_back(company[j]);
                w_.company.back().body = body(k);
                w_.unplanted.push_back(shape(k) + j);
                w_.moved_shapes.push_back(shape(k) + j);
            }
        }
        w_.has_new_box.resize(w_.shapes.size(), static_cast<std::uint8_t>(is_new | meets_anew));
        w_.extents.resize(w_.shapes.size());
        if (!w_.shapes.empty())
            w_.contact_links.make_room(
                WorldState<D>::contact_list(static_cast<std::uint32_t>(w_.shapes.size()), false));
    }

    void put_places() {
        const BodyState<D> like = w_.states[like_];
        for (const Transform<D>& placed : places_) {
            BodyState<D> s = state_at(placed, mass_.center);
            s.velocity = like.velocity;
            s.angular_velocity = like.angular_velocity;
            w_.states.push_back(s);
            for (const Model<D>& model : models_) w_.fat_boxes.push_back(first_box(*model, frame(s, mass_)));
        }
    }

    void put_movable() {
        for (std::size_t k = 0; k < places_.size(); ++k) {
            w_.measure_extents(body(k));
            w_.movable.push_back(body(k));
            w_.roused.push_back(body(k));
        }
    }

    WorldState<D>& w_;
    const BodyDefinition<D>& definition_;
    std::uint32_t like_, first_ = 0, first_shape_ = 0;
    BodyMass<D> mass_;
    const std::vector<Model<D>>& models_;
    std::span<const Transform<D>> places_;
};

/// Lets the blueprint serve the definition; true if it did not before. Throws `Error` for what cannot be.
template <int D>
bool prepare_blueprint(WorldState<D>& w, const BodyDefinition<D>& definition) {
    if (w.blueprint.serves(definition)) return false;
    draw_blueprint(w, definition, validate(definition, w.scheduler.get()));
    return true;
}

/// What has much data is not kept beyond its body.
template <int D>
void forget_large(Blueprint<D>& plan) {
    if (std::ranges::any_of(plan.shapes, [](const auto& m) { return m->shape.kind == ShapeKind::terrain; }))
        plan = {};
}

}  // namespace

template <int D>
BodyId<D> World<D>::add_body(const BodyDefinition<D>& definition) {
    WorldState<D>& w = *state_;
    const Transform<D> placed{definition.position, definition.rotation};
    validate_place(placed);
    validate_motion(definition);
    const bool is_first = prepare_blueprint(w, definition);
    make_room_for(w, 1, w.blueprint.shapes.size());
    const BodyId<D> id = put_body(w, definition, placed, is_first);
    forget_large(w.blueprint);
    return id;
}

template <int D>
std::vector<BodyId<D>> World<D>::add_bodies(const BodyDefinition<D>& definition,
                                            std::span<const Transform<D>> places) {
    WorldState<D>& w = *state_;
    std::vector<BodyId<D>> added;
    if (places.empty()) return added;
    validate_places(places);
    validate_motion(definition);
    const bool is_first = prepare_blueprint(w, definition);
    make_room_for(w, places.size(), places.size() * w.blueprint.shapes.size());
    make_room(added, places.size());
    added.push_back(put_body(w, definition, places[0], is_first));
    // Places that were used before are taken first, in the order in which they would be one by one.
    while (added.size() < places.size() && (w.body_slots.any_free() || w.shape_slots.any_free()))
        added.push_back(put_body(w, definition, places[added.size()], false));
    if (added.size() < places.size())
        Copies<D>(w, definition, added.back(), places.subspan(added.size())).put(added);
    forget_large(w.blueprint);
    return added;
}

template <int D>
ShapeId<D> World<D>::add_shape(BodyId<D> body, const ShapeDefinition<D>& definition) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(body);
    Shape<D> shape = make_shape(definition, w.scheduler.get());
    require_place_for(shape, w.types[i]);
    const ShapeId<D> id = put_shape(w, i, model_of(definition, std::move(shape)));
    w.update_mass(i);
    w.forget_manifolds_of(i);
    w.insert_leaf(id.index);
    w.wake(i);
    return id;
}

template <int D>
void World<D>::remove_shape(ShapeId<D> shape) {
    WorldState<D>& w = *state_;
    const std::uint32_t body = w.shapes[w.index(shape)].body;
    std::vector<const ShapeDefinition<D>*> rest;
    for (const ShapeId<D>& id : w.infos[body].shapes) {
        if (id != shape) rest.push_back(&w.shapes[id.index].definition());
    }
    body_mass<D>(w.types[body], overrides_of(w.infos[body]), rest);
    w.wake_neighbours(body);
    w.wake_islands();
    drop_shape(w, shape);
    w.infos[body].shapes.erase(shape);
    w.update_mass(body);
    w.forget_manifolds_of(body);
}

template <int D>
void World<D>::set_shape(ShapeId<D> shape, const ShapeDefinition<D>& definition) {
    WorldState<D>& w = *state_;
    const std::uint32_t i = w.index(shape), body = w.shapes[i].body;
    Shape<D> made = make_shape(definition, w.scheduler.get());
    require_place_for(made, w.types[body]);
    std::vector<const ShapeDefinition<D>*> all;
    for (const ShapeId<D>& id : w.infos[body].shapes)
        all.push_back(id == shape ? &definition : &w.shapes[id.index].definition());
    body_mass<D>(w.types[body], overrides_of(w.infos[body]), all);

    const Filter &before = w.shapes[i].definition().filter, &now = definition.filter;
    // Contacts with a terrain name its facets, which are others now.
    const bool is_ground = made.kind == ShapeKind::terrain || w.shapes[i].shape().kind == ShapeKind::terrain;
    const bool same_company = !is_ground && w.shapes[i].definition().sensor == definition.sensor &&
                              before.category == now.category && before.mask == now.mask &&
                              before.group == now.group;
    w.wake_neighbours(body);
    w.wake_islands();
    if (!same_company) {
        w.remove_contacts_of_shape(i);
        w.remove_visits_of(i);
    }
    w.remove_leaf(i);
    set_model(w, i, body, model_of(definition, std::move(made)));
    w.update_mass(body);
    w.forget_manifolds_of(body);
    w.insert_leaf(i);
    w.each_contact_of_shape(i, [&](std::uint32_t contact) { w.set_surface(w.contacts[contact]); });
    w.place_visits_anew(i);
}

#define CAROM_INSTANTIATE(D)                                                             \
    template BodyId<D> World<D>::add_body(const BodyDefinition<D>&);                     \
    template std::vector<BodyId<D>> World<D>::add_bodies(const BodyDefinition<D>&,       \
                                                         std::span<const Transform<D>>); \
    template ShapeId<D> World<D>::add_shape(BodyId<D>, const ShapeDefinition<D>&);       \
    template void World<D>::remove_shape(ShapeId<D>);                                    \
    template void World<D>::set_shape(ShapeId<D>, const ShapeDefinition<D>&);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom
