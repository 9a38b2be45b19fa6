// The current time, its rate, and the listeners.

const NICE = [1, 2, 5];

export class Player {
  /** `changed(time)` is called after a change of time, `state()` when playing starts or stops. */
  constructor(changed, state) {
    this.changed = changed;
    this.state = state;
    this.playing = false;
    this.loop = true;
    this.rate = 1;
    this.load([0], null);
  }

  /** Set the times (sorted) of the shown clips, and the period of a repeated clip. */
  load(times, period) {
    this.times = times;
    this.first = times[0];
    this.last = times.at(-1);
    this.period = period;
    this.time = Math.min(Math.max(this.time ?? this.first, this.first), this.last);
  }

  get duration() {
    return this.period ?? this.last - this.first;
  }

  /** Return the selectable rates: 1, 2, 5 times powers of ten around the default. */
  rates(suits) {
    const exponent = Math.floor(Math.log10(suits));
    const all = [];
    for (let e = exponent - 2; e <= exponent + 2; e++) NICE.forEach((nice) => all.push(nice * 10 ** e));
    return all.filter((rate) => rate >= suits / 25 && rate <= suits * 25).map((rate) => Number(rate.toPrecision(3)));
  }

  /** Return the default rate: real time if it lasts a few seconds, else a rate that does. */
  suitableRate() {
    const wanted = this.period ? 2 : 8;
    if (!(this.duration > 0)) return 1;
    if (!this.period && this.duration >= 4 && this.duration <= 60) return 1;
    const rate = this.duration / wanted;
    const power = 10 ** Math.floor(Math.log10(rate));
    const nice = [1, 2, 5, 10].reduce((best, x) =>
      Math.abs(Math.log((x * power) / rate)) < Math.abs(Math.log((best * power) / rate)) ? x : best,
    );
    return Number((nice * power).toPrecision(3));
  }

  /** Return the number of the frame nearest to the current time. */
  get frame() {
    const { times, time } = this;
    let low = 0;
    let high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle;
      else high = middle;
    }
    return Math.abs(times[high] - time) < Math.abs(time - times[low]) ? high : low;
  }

  go(time) {
    this.time = Math.min(Math.max(time, this.first), this.period ? this.first + this.period : this.last);
    this.changed(this.time);
  }

  goFrame(frame) {
    this.go(this.times[Math.min(Math.max(frame, 0), this.times.length - 1)]);
  }

  step(by) {
    this.pause();
    const n = this.times.length;
    this.goFrame(this.period ? (this.frame + by + n) % n : this.frame + by);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (!(this.duration > 0) || this.playing) return;
    if (this.time >= this.last && !this.period) this.go(this.first);
    this.playing = true;
    this.before = null;
    this.state();
    requestAnimationFrame((now) => this.advance(now));
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.goFrame(this.frame); // a paused picture is a frame with the values of the run
    this.state();
  }

  advance(now) {
    if (!this.playing) return;
    const passed = this.before === null ? 0 : Math.min(now - this.before, 250) / 1000;
    this.before = now;
    let time = this.time + passed * this.rate;
    const end = this.first + this.duration;
    if (time > end) {
      if (!this.loop && !this.period) {
        this.go(end);
        this.pause();
        return;
      }
      time = this.first + ((time - this.first) % this.duration);
    }
    this.go(time);
    requestAnimationFrame((next) => this.advance(next));
  }
}
