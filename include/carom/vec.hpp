#pragma once

#include <cmath>

namespace carom {

/// A vector of `D` components of type `T`: a point, a direction, a velocity or a force. The public face uses
/// `double`; the solver uses `float` and, later, SIMD lanes of it.
template <int D, class T = double>
struct Vec;

/// The vector of the plane.
template <class T>
struct Vec<2, T> {
    T x{}, y{};

    constexpr T& operator[](int i) { return i == 0 ? x : y; }
    constexpr const T& operator[](int i) const { return i == 0 ? x : y; }
    constexpr Vec& operator+=(const Vec& v) { return *this = *this + v; }
    constexpr Vec& operator-=(const Vec& v) { return *this = *this - v; }
    constexpr Vec& operator*=(T s) { return *this = *this * s; }

    friend constexpr Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y}; }
    friend constexpr Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y}; }
    friend constexpr Vec operator-(const Vec& a) { return {-a.x, -a.y}; }
    friend constexpr Vec operator*(const Vec& a, T s) { return {a.x * s, a.y * s}; }
    friend constexpr Vec operator*(T s, const Vec& a) { return {a.x * s, a.y * s}; }
    friend constexpr Vec operator/(const Vec& a, T s) { return {a.x / s, a.y / s}; }
    friend constexpr bool operator==(const Vec&, const Vec&) = default;
};

/// The vector of space.
template <class T>
struct Vec<3, T> {
    T x{}, y{}, z{};

    constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    constexpr Vec& operator+=(const Vec& v) { return *this = *this + v; }
    constexpr Vec& operator-=(const Vec& v) { return *this = *this - v; }
    constexpr Vec& operator*=(T s) { return *this = *this * s; }

    friend constexpr Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec operator*(const Vec& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec operator*(T s, const Vec& a) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec operator/(const Vec& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
    friend constexpr bool operator==(const Vec&, const Vec&) = default;
};

using Vec2 = Vec<2>;
using Vec3 = Vec<3>;

/// Scalar product a · b.
template <class T>
constexpr T dot(const Vec<2, T>& a, const Vec<2, T>& b) {
    return a.x * b.x + a.y * b.y;
}
template <class T>
constexpr T dot(const Vec<3, T>& a, const Vec<3, T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Vector product a × b; in the plane only its component out of the plane is left, a scalar.
template <class T>
constexpr T cross(const Vec<2, T>& a, const Vec<2, T>& b) {
    return a.x * b.y - a.y * b.x;
}
template <class T>
constexpr Vec<3, T> cross(const Vec<3, T>& a, const Vec<3, T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Vector product of an angular velocity w (out of the plane) and r: the velocity w × r of the point r.
template <class T>
constexpr Vec<2, T> cross(T w, const Vec<2, T>& r) {
    return {-w * r.y, w * r.x};
}

/// |a|², the squared length.
template <int D, class T>
constexpr T length_squared(const Vec<D, T>& a) {
    return dot(a, a);
}

/// |a|, the length.
template <int D, class T>
T length(const Vec<D, T>& a) {
    using std::sqrt;
    return sqrt(dot(a, a));
}

/// The unit vector along `a`; the zero vector stays zero.
template <int D, class T>
Vec<D, T> normalized(const Vec<D, T>& a) {
    const T l = length(a);
    return l > T(0) ? a / l : a;
}

}  // namespace carom
