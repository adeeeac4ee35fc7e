#include "solver/impacts.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace carom::detail {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Of the speed of the fastest approach: what is slower waits for a later round. So a touch that trembles is
/// not taken for a blow.
constexpr double slow_share = 0.05;
/// The same, of the blow that began it: what is slower does not bounce, and what is slower still is rest.
constexpr double dead_share = 1e-5, rest_share = 1e-9;
/// The same when a blow has gone on for long.
constexpr double crude_share = 1e-3;
/// What it costs to find the time of an impact, in looks at a point that touches.
constexpr std::size_t cost_of_time = 30;
/// A bounce that would last less than this share of a sub-step is rest.
constexpr double least_flight = 1.0 / 16;
/// A gap that the solver does not take for closed.
constexpr float wide = 2 * closed_gap;

template <int D>
ContactRows<D, double> widen(const ContactRows<D, float>& rows) {
    constexpr std::size_t count = sizeof(rows) / sizeof(float);
    const auto floats = std::bit_cast<std::array<float, count>>(rows);
    std::array<double, count> doubles;
    std::ranges::copy(floats, doubles.begin());
    return std::bit_cast<ContactRows<D, double>>(doubles);
}

double widen(float weight) { return weight; }
Symmetric3<double> widen(const Symmetric3<float>& weight) { return narrow<double>(weight); }

/// The first time at which s + v t + ½ a t² falls to zero, or infinity. Where it is below and falls, when it
/// did.
double time_to_close(double s, double v, double a) {
    const double squared = v * v - 2 * a * s;
    if (!(squared > 0)) return infinite;
    const double root = std::sqrt(squared);
    if (v < 0) return 2 * s / (root - v);
    return a < 0 ? (v + root) / -a : infinite;
}

}  // namespace

template <int D>
void ImpactSolver<D>::reset(const ImpactView<D>& view) {
    for (const Flight& f : flights_) flight_of_slot_[f.slot] = none;
    for (const Contact& c : contacts_) taken_[c.section][c.index] = 0;
    flights_.clear();
    contacts_.clear();
    points_.clear();
    candidates_.clear();
    links_begin_.clear();
    flight_of_slot_.resize(std::max<std::size_t>(flight_of_slot_.size(), view.slots), none);
    taken_.resize(view.stores.size());
}

/// Those with restitution whose bodies approach each other, or may by the end of the step, fast enough to
/// bounce, and come near enough to meet.
template <int D>
bool ImpactSolver<D>::find_candidates(const ImpactView<D>& view) {
    reset(view);
    const auto step = static_cast<float>(view.step), threshold = static_cast<float>(view.threshold);
    for (std::uint32_t section = 0; section < view.stores.size(); ++section) {
        const ContactStore<D>& store = *view.stores[section];
        if (!store.some_bounce()) continue;
        for (std::uint32_t index = 0; index < store.size(); ++index) {
            if (!(store.traits(index / store.width()) & some_bouncy) || store.restitution(index) == 0)
                continue;
            const std::uint32_t a = store.a(index), b = store.b(index);
            const auto rows = store.rows().get(index);
            const Motion<D, float> ma = gather<float>(view.bodies, &a).motion,
                                   mb = gather<float>(view.bodies, &b).motion;
            const Drive<D, float> da = view.drives->get(a), db = view.drives->get(b);
            const float pull = std::fabs(dot(rows.normal, db.acceleration - da.acceleration)) * step;
            for (const NormalRow<D, float>& p : rows.points) {
                if (!(p.mass > 0)) continue;
                const float speed =
                    pull - dot(rows.normal, relative_velocity(ma, mb, arm_a(rows, p), arm_b(rows, p)));
                if (speed <= threshold || p.separation > 1.5f * speed * step + 1e-3f) continue;
                candidates_.push_back({store.contact(index), section, index});
                break;
            }
        }
    }
    std::ranges::sort(candidates_, {}, &Candidate::number);
    return !candidates_.empty();
}

template <int D>
std::uint32_t ImpactSolver<D>::flight_of(std::uint32_t slot, const ImpactView<D>& view) {
    std::uint32_t& place = flight_of_slot_[slot];
    if (place == none) {
        place = static_cast<std::uint32_t>(flights_.size());
        flights_.push_back({});
        flights_.back().slot = slot;
        if (points_of_.size() < flights_.size()) points_of_.resize(flights_.size());
        points_of_[place].clear();
        load(flights_.back(), view);
    }
    return place;
}

template <int D>
void ImpactSolver<D>::load(Flight& f, const ImpactView<D>& view) {
    const Motion<D, float> now = gather<float>(view.bodies, &f.slot).motion;
    const Drive<D, float> drive = view.drives->get(f.slot);
    f.start.v = narrow<double>(drive.start) + narrow<double>(drive.lost_before);
    f.start.w = narrow<double>(drive.start_spin) + narrow<double>(drive.lost_spin_before);
    f.start.moved = narrow<double>(now.moved);
    f.start.turned = narrow<double>(now.turned);
    f.blow = {};
    f.struck = false;
    // What constraints did in the sub-step before may be the echo of a blow: what is more than the outer
    // forces could ask for is not believed.
    const double h = view.substep;
    const Vec<D> outer = narrow<double>(drive.acceleration), held = narrow<double>(drive.warm) * (1 / h);
    f.acceleration = outer - f.start.v * (static_cast<double>(drive.damping) / h);
    f.spin_acceleration = narrow<double>(drive.spin_acceleration);
    if (dot(held, held) <= 2 * dot(outer, outer)) {
        f.acceleration += held;
        f.spin_acceleration = f.spin_acceleration + narrow<double>(drive.warm_spin) * (1 / h);
    }
    if (f.slot < view.bodies.first_movable) f.acceleration = {}, f.spin_acceleration = {};
}

template <int D>
void ImpactSolver<D>::add_contact(const Candidate& c, const ImpactView<D>& view) {
    const ContactStore<D>& store = *view.stores[c.section];
    if (taken_[c.section].size() < store.size()) taken_[c.section].resize(store.size(), 0);
    if (taken_[c.section][c.index]) return;
    taken_[c.section][c.index] = 1;
    const std::uint32_t a = flight_of(store.a(c.index), view), b = flight_of(store.b(c.index), view);
    const auto contact = static_cast<std::uint32_t>(contacts_.size());
    contacts_.push_back(
        {c.section, c.index, a, b, store.restitution(c.index), widen<D>(store.rows().get(c.index))});
    for (std::uint32_t k = 0; k < Rows::capacity; ++k) {
        if (!(contacts_.back().rows.points[k].mass > 0)) continue;
        const auto point = static_cast<std::uint32_t>(points_.size());
        points_.push_back({contact, k});
        for (const std::uint32_t flight : {a, b}) points_of_[flight].push_back(point);
        expect(point, 0, view);
    }
}

/// The contacts of each body that can be pushed.
template <int D>
void ImpactSolver<D>::link_contacts(const ImpactView<D>& view) {
    links_begin_.assign(view.slots + 1, 0);
    const auto each = [&](auto&& visit) {
        for (std::uint32_t section = 0; section < view.stores.size(); ++section) {
            const ContactStore<D>& store = *view.stores[section];
            for (std::uint32_t index = 0; index < store.size(); ++index) {
                for (const std::uint32_t slot : {store.a(index), store.b(index)}) {
                    if (slot >= view.bodies.first_movable)
                        visit(slot, Candidate{store.contact(index), section, index});
                }
            }
        }
    };
    each([&](std::uint32_t slot, const Candidate&) { ++links_begin_[slot]; });
    std::uint32_t sum = 0;
    for (std::uint32_t& begin : links_begin_) sum += begin, begin = sum;
    links_.resize(sum);
    each([&](std::uint32_t slot, const Candidate& c) { links_[--links_begin_[slot]] = c; });
    for (std::uint32_t slot = 0; slot < view.slots; ++slot) {
        std::sort(links_.begin() + links_begin_[slot], links_.begin() + links_begin_[slot + 1],
                  [](const Candidate& one, const Candidate& other) { return one.number < other.number; });
    }
}

template <int D>
void ImpactSolver<D>::list_contacts_of(std::uint32_t flight, const ImpactView<D>& view) {
    const std::uint32_t slot = flights_[flight].slot;
    if (flights_[flight].listed || slot < view.bodies.first_movable) return;
    flights_[flight].listed = true;
    if (links_begin_.empty()) link_contacts(view);
    for (std::uint32_t k = links_begin_[slot]; k < links_begin_[slot + 1]; ++k) add_contact(links_[k], view);
}

template <int D>
Motion<D, double> ImpactSolver<D>::at(const Flight& f, double time) const {
    const double half = 0.5 * time * time;
    return {f.start.v + time * f.acceleration, f.start.w + time * f.spin_acceleration,
            f.start.moved + time * f.start.v + half * f.acceleration,
            f.start.turned + time * f.start.w + half * f.spin_acceleration};
}

template <int D>
double ImpactSolver<D>::gap_at(const Point& p, double time) const {
    const Contact& c = contacts_[p.contact];
    return gap(c.rows, c.rows.points[p.number], at(flights_[c.a], time), at(flights_[c.b], time));
}

template <int D>
double ImpactSolver<D>::speed_at(const Point& p, double time) const {
    const Contact& c = contacts_[p.contact];
    const NormalRow<D, double>& row = c.rows.points[p.number];
    return dot(c.rows.normal, relative_velocity(at(flights_[c.a], time), at(flights_[c.b], time),
                                                arm_a(c.rows, row), arm_b(c.rows, row)));
}

/// When, from a time on, the point is struck so that it may bounce or its body is thrown against something;
/// never, if it is left to the solver. Bodies that come on to each other and overlap at the start of the
/// sub-step did not see each other in time: they were struck before, as their paths tell.
template <int D>
void ImpactSolver<D>::find_impact(Point& p, double from, const ImpactView<D>& view) const {
    const double h = view.substep, start = gap_at(p, from), end = gap_at(p, from + h);
    const double middle = gap_at(p, from + 0.5 * h);
    const double speed = (4 * middle - 3 * start - end) / h;
    const double acceleration = 4 * (start - 2 * middle + end) / (h * h);
    p.comes = false;
    if (start <= 0 && speed_at(p, from) < 0) {
        const double ago = from > 0 ? 0 : time_to_close(start, speed, acceleration);
        p.time = from + (ago < 0 && ago > -view.step ? ago : 0);
    } else {
        p.time = from + std::max(0.0, time_to_close(start, speed, acceleration));
    }
    if (p.time == infinite) return;
    p.speed = -speed_at(p, p.time);
    const Contact& c = contacts_[p.contact];
    const bool thrown = flights_[c.a].struck || flights_[c.b].struck;
    const double least_speed = least_flight * h * std::fabs(acceleration) + 1e-9;
    const bool bounces = c.restitution > 0;
    const bool is_impact = p.speed > std::max(least_speed, view.threshold) && (bounces || thrown);
    p.comes = is_impact && bounces && p.time > h && (p.time - h) * p.speed < 4 * closed_gap;
    if (!is_impact || p.time > h) p.time = infinite;
}

/// Takes the body, and what touches it at this time, into the impact.
template <int D>
void ImpactSolver<D>::involve(std::uint32_t flight, double time, const ImpactView<D>& view) {
    list_contacts_of(flight, view);
    bodies_.resize(flights_.size());
    involved_.resize(flights_.size(), 0);
    is_touching_.resize(points_.size(), 0);
    const auto take = [&](std::uint32_t f) {
        if (involved_[f] == 0) {
            const Body<D, float> body = gather<float>(view.bodies, &flights_[f].slot);
            bodies_[f] = {at(flights_[f], time), {}};
            if (flights_[f].slot >= view.bodies.first_movable)
                bodies_[f].weight = {narrow<double>(body.weight.mass), widen(body.weight.inertia)};
            involved_flights_.push_back(f);
            involved_[f] = 1;
        }
    };
    take(flight);
    if (involved_[flight] == 2 || flights_[flight].slot < view.bodies.first_movable) return;
    involved_[flight] = 2;
    for (const std::uint32_t k : points_of_[flight]) {
        const Contact& c = contacts_[points_[k].contact];
        if (is_touching_[k] || gap_at(points_[k], time) > closed_gap) continue;
        is_touching_[k] = 1;
        touching_.push_back(k);
        take(c.a);
        take(c.b);
    }
}

/// Works out when the point is struck, and notes it in the queue.
template <int D>
void ImpactSolver<D>::expect(std::uint32_t point, double from, const ImpactView<D>& view) {
    find_impact(points_[point], from, view);
    if (points_[point].time == infinite) return;
    queue_.emplace_back(points_[point].time, point);
    std::ranges::push_heap(queue_, std::greater{});
}

/// The point that is struck first, or `none`. It is no longer in the queue.
template <int D>
std::uint32_t ImpactSolver<D>::take_first() {
    while (!queue_.empty()) {
        std::ranges::pop_heap(queue_, std::greater{});
        const auto [time, point] = queue_.back();
        queue_.pop_back();
        if (points_[point].time == time) return point;
    }
    return none;
}

/// Does the first impact of what is left of the sub-step; returns false when there is none.
template <int D>
bool ImpactSolver<D>::strike_first(const ImpactView<D>& view) {
    const std::uint32_t earliest = take_first();
    if (earliest == none) return false;
    const double time = points_[earliest].time;
    double speed = points_[earliest].speed;
    first_.assign(1, earliest);
    while (!queue_.empty() && (queue_.front().first - time) * speed <= closed_gap) {
        const std::uint32_t next = take_first();
        if (next == none) break;
        first_.push_back(next);
        speed = std::max(speed, points_[next].speed);
    }
    touching_.clear();
    involved_flights_.clear();
    for (const std::uint32_t k : first_) {
        const Point p = points_[k];
        if ((p.time - time) * p.speed > closed_gap) continue;
        involve(contacts_[p.contact].a, time, view);
        involve(contacts_[p.contact].b, time, view);
    }
    run_rounds(time, speed, view);
    apply(time);

    for (const std::uint32_t f : involved_flights_) {
        if (flights_[f].struck) first_.insert(first_.end(), points_of_[f].begin(), points_of_[f].end());
        involved_[f] = 0;
    }
    for (const std::uint32_t k : touching_) is_touching_[k] = 0;
    std::ranges::sort(first_);
    const auto repeated = std::ranges::unique(first_);
    first_.erase(repeated.begin(), repeated.end());
    for (const std::uint32_t k : first_) expect(k, time, view);
    work_ += cost_of_time * first_.size();
    return work_ < most_work();
}

template <int D>
void ImpactSolver<D>::run_rounds(double time, double speed, const ImpactView<D>& view) {
    constexpr std::size_t much_work = 4000;
    const bool bounces = speed > view.threshold;
    double rest = rest_share * speed, dead = dead_share * speed;
    std::size_t work = 0;
    while (rest < speed) {
        const auto approach = [&](std::uint32_t k) {
            const Contact& c = contacts_[points_[k].contact];
            const NormalRow<D, double>& row = c.rows.points[points_[k].number];
            return -dot(c.rows.normal, relative_velocity(bodies_[c.a].motion, bodies_[c.b].motion,
                                                         arm_a(c.rows, row), arm_b(c.rows, row)));
        };
        double fastest = 0;
        for (const std::uint32_t k : touching_) fastest = std::max(fastest, approach(k));
        if (fastest <= rest) break;
        chosen_.clear();
        strikes_.clear();
        for (const std::uint32_t k : touching_) {
            const double now = approach(k);
            if (now < slow_share * fastest || now <= rest) continue;
            const Contact& c = contacts_[points_[k].contact];
            const NormalRow<D, double>& row = c.rows.points[points_[k].number];
            const double restitution = bounces && now > dead ? c.restitution : 0;
            chosen_.push_back(k);
            strikes_.push_back({c.a,
                                c.b,
                                c.rows.normal,
                                arm_a(c.rows, row),
                                arm_b(c.rows, row),
                                frame_of(c.rows).tangents,
                                c.rows.surface_speed,
                                restitution,
                                c.rows.friction,
                                0,
                                {}});
        }
        reflection_.reflect(bodies_, strikes_);
        work += touching_.size() + 16 * chosen_.size();
        if (work > much_work) rest = std::max(2 * rest, crude_share * speed), dead = std::max(dead, rest);
        if (work_ + work > most_work()) break;
        for (std::size_t i = 0; i < chosen_.size(); ++i) {
            tally(strikes_[i], points_[chosen_[i]], view);
            points_[chosen_[i]].struck = true;
            involve(strikes_[i].a, time, view);
            involve(strikes_[i].b, time, view);
        }
    }
    work_ += work;
}

/// What the rows say of the step's impulses includes the blow.
template <int D>
void ImpactSolver<D>::tally(const ImpactPoint<D>& struck, const Point& p, const ImpactView<D>& view) const {
    const Contact& c = contacts_[p.contact];
    auto& rows = view.stores[c.section]->rows();
    const ContactRows<D, float> model;
    rows.at(c.index, field_of(model, model.points[p.number].total_impulse)) +=
        static_cast<float>(struck.impulse);
    for (int k = 0; k < D - 1; ++k)
        rows.at(c.index, field_of(model, model.total_friction[k])) +=
            static_cast<float>(struck.tangential[k]);
}

template <int D>
void ImpactSolver<D>::apply(double time) {
    for (const std::uint32_t f : involved_flights_) {
        Flight& flight = flights_[f];
        const Motion<D, double> before = at(flight, time), &after = bodies_[f].motion;
        const Vec<D> v = after.v - before.v;
        const Angular<D> w = after.w - before.w;
        if (v == Vec<D>{} && w == Angular<D>{}) continue;
        flight.struck = true;
        for (Motion<D, double>* m : {&flight.start, &flight.blow}) {
            m->v += v;
            m->w = m->w + w;
            m->moved -= time * v;
            m->turned = m->turned - time * w;
        }
    }
}

template <int D>
void ImpactSolver<D>::strike(const ImpactView<D>& view) {
    straighten(view);
    queue_.clear();
    work_ = 0;
    for (Flight& f : flights_) load(f, view);
    for (Point& p : points_) p.struck = false;
    if (contacts_.empty()) {
        for (const Candidate& c : candidates_) add_contact(c, view);
    } else {
        for (std::uint32_t k = 0; k < points_.size(); ++k) expect(k, 0, view);
    }
    while (strike_first(view)) {
    }

    for (const Flight& f : flights_) {
        if (!f.struck || f.slot < view.bodies.first_movable) continue;
        Body<D, float> body = gather<float>(view.bodies, &f.slot);
        Drive<D, float> drive = view.drives->get(f.slot);
        const auto split = [](const auto& whole, auto& rounded, auto& rest) {
            rounded = narrow<float>(whole);
            rest = narrow<float>(std::remove_cvref_t<decltype(whole)>(whole - narrow<double>(rounded)));
        };
        split(Vec<D>(narrow<double>(body.motion.v) + narrow<double>(drive.lost) + f.blow.v), body.motion.v,
              drive.lost);
        split(Angular<D>(narrow<double>(body.motion.w) + narrow<double>(drive.lost_spin) + f.blow.w),
              body.motion.w, drive.lost_spin);
        split(Vec<D>(narrow<double>(drive.start) + narrow<double>(drive.lost_before) + f.blow.v), drive.start,
              drive.lost_before);
        split(
            Angular<D>(narrow<double>(drive.start_spin) + narrow<double>(drive.lost_spin_before) + f.blow.w),
            drive.start_spin, drive.lost_spin_before);
        view.drives->set(f.slot, drive);
        scatter_velocity(view.bodies, &f.slot, body, false);
    }
    bend_gaps(view);
}

template <int D>
float& ImpactSolver<D>::separation_of(const Point& p, const ImpactView<D>& view) const {
    const Contact& c = contacts_[p.contact];
    const ContactRows<D, float> model;
    return view.stores[c.section]->rows().at(c.index, field_of(model, model.points[p.number].separation));
}

/// The solver lets bodies approach each other by the gap now over the length of the sub-step, as fast as they
/// are at its end. For a body that was struck at τ the gap now has to be that at which its path after τ would
/// have begun, and more by what it falls less than that. Where this is an overlap, the body was struck here
/// and is on its way out: then any open gap will do. While velocities are relaxed, a gap that is open at the
/// end has to look so, though what it falls less is not yet taken off; and where the body bounced or will
/// bounce by itself, it must not be so small that the solver takes it for closed.
template <int D>
void ImpactSolver<D>::bend_gaps(const ImpactView<D>& view) {
    constexpr double open = 1e-6;
    const double h = view.substep;
    for (std::uint32_t k = 0; k < points_.size(); ++k) {
        const Point& p = points_[k];
        const Contact& c = contacts_[p.contact];
        const Flight &a = flights_[c.a], &b = flights_[c.b];
        const bool blown = a.struck || b.struck, may_bounce = c.restitution > 0;
        if (!blown && !may_bounce) continue;
        const auto before = [](const Flight& f) {
            Motion<D, double> m = f.start;
            m.moved -= f.blow.moved;
            m.turned = m.turned - f.blow.turned;
            return m;
        };
        const double now = gap(c.rows, c.rows.points[p.number], before(a), before(b)), end = gap_at(p, h);
        const double way = h * speed_at(p, h) + c.rows.lead;
        if ((now <= 0 && !p.struck) || (!blown && end <= 0)) continue;
        const bool flies = may_bounce && end >= 0, bounces = p.comes || (p.struck && flies);
        const double more = (bounces ? wide : 0.0);
        const double wanted = std::max(end - way, open) + more;
        const double relaxed = flies ? end - (gap_at(p, 0) + way) + more : 0;
        if (!blown && wanted <= now && relaxed <= 0) continue;
        float& separation = separation_of(p, view);
        bent_.push_back({k, separation, separation + static_cast<float>(relaxed)});
        separation += static_cast<float>(wanted - now);
    }
}

template <int D>
void ImpactSolver<D>::straighten(const ImpactView<D>& view) {
    for (const Bent& bent : bent_) separation_of(points_[bent.point], view) = bent.separation;
    bent_.clear();
}

template <int D>
void ImpactSolver<D>::shift(const ImpactView<D>& view) {
    for (const Bent& bent : bent_) separation_of(points_[bent.point], view) = bent.relaxed;
    for (const Flight& f : flights_) {
        if (!f.struck || f.slot < view.bodies.first_movable) continue;
        Body<D, float> body = gather<float>(view.bodies, &f.slot);
        body.motion.moved += narrow<float>(f.blow.moved);
        body.motion.turned = body.motion.turned + narrow<float>(f.blow.turned);
        scatter_way(view.bodies, &f.slot, body);
    }
}

template class ImpactSolver<2>;
template class ImpactSolver<3>;

}  // namespace carom::detail
