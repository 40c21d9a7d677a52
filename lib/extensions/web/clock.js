// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated time as people read it.

/** The time of a world whose steps take dt seconds, with as many decimals as a step has. */
export function timeText(t, dt) {
  const decimals = dt > 0 ? Math.min(3, Math.max(0, Math.ceil(-Math.log10(dt) - 1e-9))) : 2;
  return `${t.toFixed(decimals)} s`;
}

let is_lived = false;
/** Whether the hour matters, so that moments are times of day. */
export function showHours(on) { is_lived = on; }

/** A moment of the run, in seconds with so many decimals, or as a time of day. */
export function momentText(t, decimals = 1) { return is_lived ? dayText(t) : `${t.toFixed(decimals)} s`; }

/** Day and time of day, for runs that people live in. */
export function dayText(t) {
  const seconds = Math.floor(t + 1e-6), two = number => String(number).padStart(2, '0');
  const time = [seconds / 3600 % 24, seconds / 60 % 60, seconds % 60].map(part => two(Math.floor(part))).join(':');
  return `day ${Math.floor(seconds / 86400) + 1}, ${time}`;
}
