// SPDX-License-Identifier: Apache-2.0
// Lanes of floats on Highway, for formulas over a type Real: operators and functions of float and
// vec3. Comparisons yield masks, for select(). Without an include guard; included in a namespace
// between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE.

namespace hn = hwy::HWY_NAMESPACE;

struct Lanes {
  using D = hn::CappedTag<float, 16>;
  using Mask = hn::Mask<D>;

  Lanes() = default;
  HWY_INLINE Lanes(hn::Vec<D> lanes) : v(lanes) {}
  HWY_INLINE Lanes(float all) : v(hn::Set(D(), all)) {}

  hn::Vec<D> v;
};

HWY_INLINE Lanes load_lanes(const float* from) {
  return hn::LoadU(Lanes::D(), from);
}
HWY_INLINE void store_lanes(float* to, Lanes lanes) {
  hn::StoreU(lanes.v, Lanes::D(), to);
}

HWY_INLINE Lanes operator+(Lanes a, Lanes b) {
  return hn::Add(a.v, b.v);
}
HWY_INLINE Lanes operator-(Lanes a, Lanes b) {
  return hn::Sub(a.v, b.v);
}
HWY_INLINE Lanes operator*(Lanes a, Lanes b) {
  return hn::Mul(a.v, b.v);
}
HWY_INLINE Lanes operator/(Lanes a, Lanes b) {
  return hn::Div(a.v, b.v);
}
HWY_INLINE void operator+=(Lanes& a, Lanes b) {
  a = a + b;
}
HWY_INLINE Lanes min(Lanes a, Lanes b) {
  return hn::Min(a.v, b.v);
}
HWY_INLINE Lanes max(Lanes a, Lanes b) {
  return hn::Max(a.v, b.v);
}
HWY_INLINE Lanes sqrt(Lanes a) {
  return hn::Sqrt(a.v);
}

HWY_INLINE Lanes::Mask operator>(Lanes a, Lanes b) {
  return hn::Gt(a.v, b.v);
}
HWY_INLINE Lanes::Mask operator>=(Lanes a, Lanes b) {
  return hn::Ge(a.v, b.v);
}
HWY_INLINE Lanes::Mask operator==(Lanes a, Lanes b) {
  return hn::Eq(a.v, b.v);
}
HWY_INLINE Lanes::Mask operator!=(Lanes a, Lanes b) {
  return hn::Ne(a.v, b.v);
}
HWY_INLINE Lanes select(Lanes::Mask condition, Lanes yes, Lanes no) {
  return hn::IfThenElse(condition, yes.v, no.v);
}
/// The number is known to the compiler: selecting 0 is cheaper than selecting another one.
HWY_INLINE Lanes select(Lanes::Mask condition, Lanes yes, float no) {
  return no == 0.0f ? hn::IfThenElseZero(condition, yes.v)
                    : hn::IfThenElse(condition, yes.v, Lanes(no).v);
}
HWY_INLINE bool all_zero(Lanes a) {
  return hn::AllTrue(Lanes::D(), a == 0.0f);
}

/// Vectors of three components, one for each lane.
struct Lanes3 {
  Lanes3() = default;
  HWY_INLINE Lanes3(Lanes a, Lanes b, Lanes c) : x(a), y(b), z(c) {}
  HWY_INLINE explicit Lanes3(Lanes all) : x(all), y(all), z(all) {}

  Lanes x, y, z;
};

HWY_INLINE Lanes3 operator+(Lanes3 a, Lanes3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Lanes3 operator-(Lanes3 a, Lanes3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Lanes3 operator*(Lanes3 a, Lanes3 b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
HWY_INLINE Lanes3 operator*(Lanes3 a, Lanes b) {
  return {a.x * b, a.y * b, a.z * b};
}
HWY_INLINE void operator+=(Lanes3& a, Lanes3 b) {
  a = a + b;
}
HWY_INLINE Lanes dot(Lanes3 a, Lanes3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE Lanes3 cross(Lanes3 a, Lanes3 b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
HWY_INLINE Lanes3 normalize(Lanes3 a) {
  return a * (1.0f / sqrt(dot(a, a)));
}
HWY_INLINE Lanes3 select(Lanes::Mask condition, Lanes3 yes, Lanes3 no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y),
          select(condition, yes.z, no.z)};
}
