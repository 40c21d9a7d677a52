// SPDX-License-Identifier: GPL-3.0-or-later
// The functors that programs name: ArFunctorC, ArRetFunctor1C, ArGlobalFunctor2 and their kin, over
// the calls of functor.h. They are made of a member function (an object by pointer or reference,
// the function, values for its parameters), of a constant one, or of a free function.
//
//     ArFunctor1C<Driver, int> turn(driver, &Driver::turn, 90);
//     turn.invoke();  // driver.turn(90)
#ifndef SIM_ARIA_FUNCTOR_KINDS_H
#define SIM_ARIA_FUNCTOR_KINDS_H

#include <utility>

#include <sim_aria/functor.h>

template <class T>
class ArFunctorC : public sim_aria::Call0 {
  public:
    /// Has no effect.
    ArFunctorC() : sim_aria::Call0([] {}) {}
    ArFunctorC(T* object, void (T::*function)())
        : sim_aria::Call0([=]() { (object->*function)(); }) {}
    ArFunctorC(T& object, void (T::*function)()) : ArFunctorC(&object, function) {}
};

template <class T, class P1>
class ArFunctor1C : public sim_aria::Call1<P1> {
  public:
    ArFunctor1C() : sim_aria::Call1<P1>([](P1) {}, sim_aria::Stored<P1>()) {}
    ArFunctor1C(T* object, void (T::*function)(P1),
                sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : sim_aria::Call1<P1>([=](P1 a1) { (object->*function)(std::forward<P1>(a1)); }, p1) {}
    ArFunctor1C(T& object, void (T::*function)(P1),
                sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : ArFunctor1C(&object, function, p1) {}
};

template <class T, class P1, class P2>
class ArFunctor2C : public sim_aria::Call2<P1, P2> {
  public:
    ArFunctor2C(T* object, void (T::*function)(P1, P2),
                sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : sim_aria::Call2<P1, P2>(
              [=](P1 a1, P2 a2) {
                  (object->*function)(std::forward<P1>(a1), std::forward<P2>(a2));
              },
              p1, p2) {}
    ArFunctor2C(T& object, void (T::*function)(P1, P2),
                sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : ArFunctor2C(&object, function, p1, p2) {}
};

template <class T, class P1, class P2, class P3>
class ArFunctor3C : public sim_aria::Call3<P1, P2, P3> {
  public:
    ArFunctor3C(T* object, void (T::*function)(P1, P2, P3),
                sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>(),
                sim_aria::Stored<P3> p3 = sim_aria::Stored<P3>())
        : sim_aria::Call3<P1, P2, P3>(
              [=](P1 a1, P2 a2, P3 a3) {
                  (object->*function)(std::forward<P1>(a1), std::forward<P2>(a2),
                                      std::forward<P3>(a3));
              },
              p1, p2, p3) {}
    ArFunctor3C(T& object, void (T::*function)(P1, P2, P3),
                sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>(),
                sim_aria::Stored<P3> p3 = sim_aria::Stored<P3>())
        : ArFunctor3C(&object, function, p1, p2, p3) {}
};

template <class T>
class ArConstFunctorC : public sim_aria::Call0 {
  public:
    ArConstFunctorC(const T* object, void (T::*function)() const)
        : sim_aria::Call0([=]() { (object->*function)(); }) {}
    ArConstFunctorC(const T& object, void (T::*function)() const)
        : ArConstFunctorC(&object, function) {}
};

template <class T, class P1>
class ArConstFunctor1C : public sim_aria::Call1<P1> {
  public:
    ArConstFunctor1C(const T* object, void (T::*function)(P1) const,
                     sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : sim_aria::Call1<P1>([=](P1 a1) { (object->*function)(std::forward<P1>(a1)); }, p1) {}
    ArConstFunctor1C(const T& object, void (T::*function)(P1) const,
                     sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : ArConstFunctor1C(&object, function, p1) {}
};

template <class T, class P1, class P2>
class ArConstFunctor2C : public sim_aria::Call2<P1, P2> {
  public:
    ArConstFunctor2C(const T* object, void (T::*function)(P1, P2) const,
                     sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                     sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : sim_aria::Call2<P1, P2>(
              [=](P1 a1, P2 a2) {
                  (object->*function)(std::forward<P1>(a1), std::forward<P2>(a2));
              },
              p1, p2) {}
    ArConstFunctor2C(const T& object, void (T::*function)(P1, P2) const,
                     sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                     sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : ArConstFunctor2C(&object, function, p1, p2) {}
};

template <class Ret, class T>
class ArRetFunctorC : public sim_aria::RetCall0<Ret> {
  public:
    /// Returns the value 0, or an empty one.
    ArRetFunctorC() : sim_aria::RetCall0<Ret>([] { return Ret(); }) {}
    ArRetFunctorC(T* object, Ret (T::*function)())
        : sim_aria::RetCall0<Ret>([=]() { return (object->*function)(); }) {}
    ArRetFunctorC(T& object, Ret (T::*function)()) : ArRetFunctorC(&object, function) {}
};

template <class Ret, class T, class P1>
class ArRetFunctor1C : public sim_aria::RetCall1<Ret, P1> {
  public:
    /// Returns the value 0, or an empty one.
    ArRetFunctor1C()
        : sim_aria::RetCall1<Ret, P1>([](P1) { return Ret(); }, sim_aria::Stored<P1>()) {}
    ArRetFunctor1C(T* object, Ret (T::*function)(P1),
                   sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : sim_aria::RetCall1<Ret, P1>(
              [=](P1 a1) { return (object->*function)(std::forward<P1>(a1)); }, p1) {}
    ArRetFunctor1C(T& object, Ret (T::*function)(P1),
                   sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : ArRetFunctor1C(&object, function, p1) {}
};

template <class Ret, class T, class P1, class P2>
class ArRetFunctor2C : public sim_aria::RetCall2<Ret, P1, P2> {
  public:
    /// Returns the value 0, or an empty one.
    ArRetFunctor2C()
        : sim_aria::RetCall2<Ret, P1, P2>([](P1, P2) { return Ret(); }, sim_aria::Stored<P1>(),
                                          sim_aria::Stored<P2>()) {}
    ArRetFunctor2C(T* object, Ret (T::*function)(P1, P2),
                   sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                   sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : sim_aria::RetCall2<Ret, P1, P2>(
              [=](P1 a1, P2 a2) {
                  return (object->*function)(std::forward<P1>(a1), std::forward<P2>(a2));
              },
              p1, p2) {}
    ArRetFunctor2C(T& object, Ret (T::*function)(P1, P2),
                   sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                   sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : ArRetFunctor2C(&object, function, p1, p2) {}
};

template <class Ret, class T, class P1, class P2, class P3>
class ArRetFunctor3C : public sim_aria::RetCall3<Ret, P1, P2, P3> {
  public:
    /// Returns the value 0, or an empty one.
    ArRetFunctor3C()
        : sim_aria::RetCall3<Ret, P1, P2, P3>([](P1, P2, P3) { return Ret(); },
                                              sim_aria::Stored<P1>(), sim_aria::Stored<P2>(),
                                              sim_aria::Stored<P3>()) {}
    ArRetFunctor3C(T* object, Ret (T::*function)(P1, P2, P3),
                   sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                   sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>(),
                   sim_aria::Stored<P3> p3 = sim_aria::Stored<P3>())
        : sim_aria::RetCall3<Ret, P1, P2, P3>(
              [=](P1 a1, P2 a2, P3 a3) {
                  return (object->*function)(std::forward<P1>(a1), std::forward<P2>(a2),
                                             std::forward<P3>(a3));
              },
              p1, p2, p3) {}
    ArRetFunctor3C(T& object, Ret (T::*function)(P1, P2, P3),
                   sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                   sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>(),
                   sim_aria::Stored<P3> p3 = sim_aria::Stored<P3>())
        : ArRetFunctor3C(&object, function, p1, p2, p3) {}
};

template <class Ret, class T>
class ArConstRetFunctorC : public sim_aria::RetCall0<Ret> {
  public:
    ArConstRetFunctorC(const T* object, Ret (T::*function)() const)
        : sim_aria::RetCall0<Ret>([=]() { return (object->*function)(); }) {}
    ArConstRetFunctorC(const T& object, Ret (T::*function)() const)
        : ArConstRetFunctorC(&object, function) {}
};

template <class Ret, class T, class P1>
class ArConstRetFunctor1C : public sim_aria::RetCall1<Ret, P1> {
  public:
    ArConstRetFunctor1C(const T* object, Ret (T::*function)(P1) const,
                        sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : sim_aria::RetCall1<Ret, P1>(
              [=](P1 a1) { return (object->*function)(std::forward<P1>(a1)); }, p1) {}
    ArConstRetFunctor1C(const T& object, Ret (T::*function)(P1) const,
                        sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : ArConstRetFunctor1C(&object, function, p1) {}
};

template <class Ret, class T, class P1, class P2>
class ArConstRetFunctor2C : public sim_aria::RetCall2<Ret, P1, P2> {
  public:
    ArConstRetFunctor2C(const T* object, Ret (T::*function)(P1, P2) const,
                        sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                        sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : sim_aria::RetCall2<Ret, P1, P2>(
              [=](P1 a1, P2 a2) {
                  return (object->*function)(std::forward<P1>(a1), std::forward<P2>(a2));
              },
              p1, p2) {}
    ArConstRetFunctor2C(const T& object, Ret (T::*function)(P1, P2) const,
                        sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                        sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : ArConstRetFunctor2C(&object, function, p1, p2) {}
};

class ArGlobalFunctor : public sim_aria::Call0 {
  public:
    explicit ArGlobalFunctor(void (*function)()) : sim_aria::Call0(function) {}
};

template <class P1>
class ArGlobalFunctor1 : public sim_aria::Call1<P1> {
  public:
    explicit ArGlobalFunctor1(void (*function)(P1),
                              sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : sim_aria::Call1<P1>(function, p1) {}
};

template <class P1, class P2>
class ArGlobalFunctor2 : public sim_aria::Call2<P1, P2> {
  public:
    explicit ArGlobalFunctor2(void (*function)(P1, P2),
                              sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                              sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : sim_aria::Call2<P1, P2>(function, p1, p2) {}
};

template <class P1, class P2, class P3>
class ArGlobalFunctor3 : public sim_aria::Call3<P1, P2, P3> {
  public:
    explicit ArGlobalFunctor3(void (*function)(P1, P2, P3),
                              sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                              sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>(),
                              sim_aria::Stored<P3> p3 = sim_aria::Stored<P3>())
        : sim_aria::Call3<P1, P2, P3>(function, p1, p2, p3) {}
};

template <class Ret>
class ArGlobalRetFunctor : public sim_aria::RetCall0<Ret> {
  public:
    explicit ArGlobalRetFunctor(Ret (*function)()) : sim_aria::RetCall0<Ret>(function) {}
};

template <class Ret, class P1>
class ArGlobalRetFunctor1 : public sim_aria::RetCall1<Ret, P1> {
  public:
    explicit ArGlobalRetFunctor1(Ret (*function)(P1),
                                 sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>())
        : sim_aria::RetCall1<Ret, P1>(function, p1) {}
};

template <class Ret, class P1, class P2>
class ArGlobalRetFunctor2 : public sim_aria::RetCall2<Ret, P1, P2> {
  public:
    explicit ArGlobalRetFunctor2(Ret (*function)(P1, P2),
                                 sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                                 sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>())
        : sim_aria::RetCall2<Ret, P1, P2>(function, p1, p2) {}
};

template <class Ret, class P1, class P2, class P3>
class ArGlobalRetFunctor3 : public sim_aria::RetCall3<Ret, P1, P2, P3> {
  public:
    explicit ArGlobalRetFunctor3(Ret (*function)(P1, P2, P3),
                                 sim_aria::Stored<P1> p1 = sim_aria::Stored<P1>(),
                                 sim_aria::Stored<P2> p2 = sim_aria::Stored<P2>(),
                                 sim_aria::Stored<P3> p3 = sim_aria::Stored<P3>())
        : sim_aria::RetCall3<Ret, P1, P2, P3>(function, p1, p2, p3) {}
};

#endif  // SIM_ARIA_FUNCTOR_KINDS_H
