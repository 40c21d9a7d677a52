// SPDX-License-Identifier: GPL-3.0-or-later
// Stored parameters are copies, also of references: later changes of the caller's variable do not
// show. The object of a member function must outlive the functor. Calls take no lock.
#ifndef SIM_ARIA_FUNCTOR_H
#define SIM_ARIA_FUNCTOR_H

#include <cstdarg>
#include <cstdio>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>

/// Functions as objects, as ARIA passes them: ArFunctorN calls a function of N parameters, the
/// stored ones where the caller gives fewer. Names end in C for a member function, begin with
/// ArConst for a constant one and with ArGlobal for a free function; Ret returns a value.
class ArFunctor {
  public:
    virtual ~ArFunctor() {}
    virtual void invoke() = 0;
    const char* getName() const { return myName.c_str(); }
    void setName(const char* text, ...) __attribute__((format(printf, 2, 3))) {
        char name[512];
        va_list values;
        va_start(values, text);
        std::vsnprintf(name, sizeof name, text, values);
        va_end(values);
        myName = name;
    }

  private:
    std::string myName;
};

/// A functor with a result; invoke() drops it.
template <class Ret>
class ArRetFunctor : public ArFunctor {
  public:
    void invoke() override { static_cast<void>(invokeR()); }
    virtual Ret invokeR() = 0;
};

template <class P1>
class ArFunctor1 : public ArFunctor {
  public:
    using ArFunctor::invoke;
    virtual void invoke(P1 p1) = 0;
};

template <class P1, class P2>
class ArFunctor2 : public ArFunctor1<P1> {
  public:
    using ArFunctor1<P1>::invoke;
    virtual void invoke(P1 p1, P2 p2) = 0;
};

template <class P1, class P2, class P3>
class ArFunctor3 : public ArFunctor2<P1, P2> {
  public:
    using ArFunctor2<P1, P2>::invoke;
    virtual void invoke(P1 p1, P2 p2, P3 p3) = 0;
};

template <class Ret, class P1>
class ArRetFunctor1 : public ArRetFunctor<Ret> {
  public:
    using ArRetFunctor<Ret>::invokeR;
    virtual Ret invokeR(P1 p1) = 0;
};

template <class Ret, class P1, class P2>
class ArRetFunctor2 : public ArRetFunctor1<Ret, P1> {
  public:
    using ArRetFunctor1<Ret, P1>::invokeR;
    virtual Ret invokeR(P1 p1, P2 p2) = 0;
};

template <class Ret, class P1, class P2, class P3>
class ArRetFunctor3 : public ArRetFunctor2<Ret, P1, P2> {
  public:
    using ArRetFunctor2<Ret, P1, P2>::invokeR;
    virtual Ret invokeR(P1 p1, P2 p2, P3 p3) = 0;
};

namespace sim_aria {

// Implementations of the interfaces above by a function and the stored parameters.
template <class P>
using Stored = typename std::decay<P>::type;

class Call0 : public ArFunctor {
  public:
    explicit Call0(std::function<void()> call) : call_(std::move(call)) {}
    void invoke() override { call_(); }

  private:
    std::function<void()> call_;
};

template <class P1>
class Call1 : public ArFunctor1<P1> {
  public:
    Call1(std::function<void(P1)> call, Stored<P1> p1)
        : call_(std::move(call)), p1_(std::move(p1)) {}
    void invoke() override { call_(p1_); }
    void invoke(P1 p1) override { call_(std::forward<P1>(p1)); }
    void setP1(P1 p1) { p1_ = std::forward<P1>(p1); }

  private:
    std::function<void(P1)> call_;
    Stored<P1> p1_;
};

template <class P1, class P2>
class Call2 : public ArFunctor2<P1, P2> {
  public:
    Call2(std::function<void(P1, P2)> call, Stored<P1> p1, Stored<P2> p2)
        : call_(std::move(call)), p1_(std::move(p1)), p2_(std::move(p2)) {}
    void invoke() override { call_(p1_, p2_); }
    void invoke(P1 p1) override { call_(std::forward<P1>(p1), p2_); }
    void invoke(P1 p1, P2 p2) override { call_(std::forward<P1>(p1), std::forward<P2>(p2)); }
    void setP1(P1 p1) { p1_ = std::forward<P1>(p1); }
    void setP2(P2 p2) { p2_ = std::forward<P2>(p2); }

  private:
    std::function<void(P1, P2)> call_;
    Stored<P1> p1_;
    Stored<P2> p2_;
};

template <class P1, class P2, class P3>
class Call3 : public ArFunctor3<P1, P2, P3> {
  public:
    Call3(std::function<void(P1, P2, P3)> call, Stored<P1> p1, Stored<P2> p2, Stored<P3> p3)
        : call_(std::move(call)), p1_(std::move(p1)), p2_(std::move(p2)), p3_(std::move(p3)) {}
    void invoke() override { call_(p1_, p2_, p3_); }
    void invoke(P1 p1) override { call_(std::forward<P1>(p1), p2_, p3_); }
    void invoke(P1 p1, P2 p2) override { call_(std::forward<P1>(p1), std::forward<P2>(p2), p3_); }
    void invoke(P1 p1, P2 p2, P3 p3) override {
        call_(std::forward<P1>(p1), std::forward<P2>(p2), std::forward<P3>(p3));
    }
    void setP1(P1 p1) { p1_ = std::forward<P1>(p1); }
    void setP2(P2 p2) { p2_ = std::forward<P2>(p2); }
    void setP3(P3 p3) { p3_ = std::forward<P3>(p3); }

  private:
    std::function<void(P1, P2, P3)> call_;
    Stored<P1> p1_;
    Stored<P2> p2_;
    Stored<P3> p3_;
};

template <class Ret>
class RetCall0 : public ArRetFunctor<Ret> {
  public:
    explicit RetCall0(std::function<Ret()> call) : call_(std::move(call)) {}
    Ret invokeR() override { return call_(); }

  private:
    std::function<Ret()> call_;
};

template <class Ret, class P1>
class RetCall1 : public ArRetFunctor1<Ret, P1> {
  public:
    RetCall1(std::function<Ret(P1)> call, Stored<P1> p1)
        : call_(std::move(call)), p1_(std::move(p1)) {}
    Ret invokeR() override { return call_(p1_); }
    Ret invokeR(P1 p1) override { return call_(std::forward<P1>(p1)); }
    void setP1(P1 p1) { p1_ = std::forward<P1>(p1); }

  private:
    std::function<Ret(P1)> call_;
    Stored<P1> p1_;
};

template <class Ret, class P1, class P2>
class RetCall2 : public ArRetFunctor2<Ret, P1, P2> {
  public:
    RetCall2(std::function<Ret(P1, P2)> call, Stored<P1> p1, Stored<P2> p2)
        : call_(std::move(call)), p1_(std::move(p1)), p2_(std::move(p2)) {}
    Ret invokeR() override { return call_(p1_, p2_); }
    Ret invokeR(P1 p1) override { return call_(std::forward<P1>(p1), p2_); }
    Ret invokeR(P1 p1, P2 p2) override { return call_(std::forward<P1>(p1), std::forward<P2>(p2)); }
    void setP1(P1 p1) { p1_ = std::forward<P1>(p1); }
    void setP2(P2 p2) { p2_ = std::forward<P2>(p2); }

  private:
    std::function<Ret(P1, P2)> call_;
    Stored<P1> p1_;
    Stored<P2> p2_;
};

template <class Ret, class P1, class P2, class P3>
class RetCall3 : public ArRetFunctor3<Ret, P1, P2, P3> {
  public:
    RetCall3(std::function<Ret(P1, P2, P3)> call, Stored<P1> p1, Stored<P2> p2, Stored<P3> p3)
        : call_(std::move(call)), p1_(std::move(p1)), p2_(std::move(p2)), p3_(std::move(p3)) {}
    Ret invokeR() override { return call_(p1_, p2_, p3_); }
    Ret invokeR(P1 p1) override { return call_(std::forward<P1>(p1), p2_, p3_); }
    Ret invokeR(P1 p1, P2 p2) override {
        return call_(std::forward<P1>(p1), std::forward<P2>(p2), p3_);
    }
    Ret invokeR(P1 p1, P2 p2, P3 p3) override {
        return call_(std::forward<P1>(p1), std::forward<P2>(p2), std::forward<P3>(p3));
    }
    void setP1(P1 p1) { p1_ = std::forward<P1>(p1); }
    void setP2(P2 p2) { p2_ = std::forward<P2>(p2); }
    void setP3(P3 p3) { p3_ = std::forward<P3>(p3); }

  private:
    std::function<Ret(P1, P2, P3)> call_;
    Stored<P1> p1_;
    Stored<P2> p2_;
    Stored<P3> p3_;
};

}  // namespace sim_aria

#endif  // SIM_ARIA_FUNCTOR_H
