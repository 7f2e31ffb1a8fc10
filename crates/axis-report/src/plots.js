"use strict";
// Puts a uPlot canvas in place of each picture that has its points beside it. Pictures stay in
// the page: print shows them, and so does a browser that does not run this.
(() => {
  const PREFIX = { "-15": "f", "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G" };
  const MINUS = "\u2212";
  const linked = new Map();
  const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const signed = text => text.replace(/^-(?=.*[1-9])/, MINUS).replace(/^-/, "");
  const raised = n => String(n).replace(/./g, c => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);

  // Start, step and differences to values.
  const values = ([start, step, steps], log) => {
    let sum = 0;
    return steps.map(d => {
      sum += d;
      const v = start + step * sum;
      return log ? 10 ** v : v;
    });
  };

  // Power of ten in which a value of this size is read: as Unit::reading in unit.rs.
  const reading = (axis, size) => {
    const [low, high] = axis.prefixes;
    if (low === high || !(size > 0)) return 0;
    const power = Math.floor(Math.log10(size) + 1e-9);
    return Math.min(high, Math.max(low, 3 * Math.floor(power / 3)));
  };

  // A value with its unit, four digits: as `engineering` in unit.rs.
  const quantity = (axis, value) => {
    if (value == null) return "–";
    const rounded = Number(value.toPrecision(4));
    const exponent = reading(axis, Math.abs(rounded));
    const unit = (PREFIX[exponent] + axis.unit).replace(/^(?=.)/, "\u00a0");
    const number = rounded / 10 ** exponent;
    const power = number === 0 ? 0 : Math.floor(Math.log10(Math.abs(number)) + 1e-12);
    if (power >= -3 && power < 6) return signed(number.toFixed(number === 0 ? 0 : Math.max(0, 3 - power))) + unit;
    const mantissa = (number / 10 ** power).toFixed(3);
    return signed(mantissa) + "·10" + raised(power) + unit;
  };

  // Points of all series over one list of places, as uPlot wants them.
  const aligned = figure => {
    const points = figure.series.flatMap((s, k) => {
      const y = values(s.y, figure.y.log);
      return values(s.x, figure.x.log).map((x, i) => [x, k, y[i]]);
    });
    points.sort((a, b) => a[0] - b[0]);
    const xs = [], columns = figure.series.map(() => []);
    let first = 0;
    for (const [x, k, y] of points) {
      if (xs.length === 0 || xs[xs.length - 1] !== x) first = xs.length;
      // Points of one series at one place each have a row of their own.
      let row = first;
      while (row < xs.length && columns[k][row] !== undefined) row++;
      if (row === xs.length) xs.push(x);
      columns[k][row] = y;
    }
    for (const c of columns) c.length = xs.length;
    return [xs, ...columns];
  };

  const size = scale => Math.max(Math.abs(scale.min), Math.abs(scale.max));

  // An axis whose ticks and label take the prefix that the visible range reads best in.
  const axis = (own, key, rows) => {
    const exponent = u => (own.log ? 0 : reading(own, size(u.scales[key])));
    const plain = (u, splits, _axis, _space, step) => {
      const unit = 10 ** exponent(u);
      let digits = 0;
      while (digits < 12 && Math.abs((step / unit) * 10 ** digits - Math.round((step / unit) * 10 ** digits)) > 1e-6) digits++;
      return splits.map(v => {
        const text = (v / unit).toFixed(digits);
        return text.length > 8 ? signed((v / unit).toPrecision(5)) : signed(text);
      });
    };
    // Over less than two decades 2 and 5 are labelled too.
    const decades = (u, splits) => splits.map(v => {
      if (v == null) return "";
      const power = Math.floor(Math.log10(v) + 1e-9);
      const mantissa = Math.round(v / 10 ** power);
      const few = u.scales[key].max < 100 * u.scales[key].min;
      if (mantissa !== 1 && !(few && (mantissa === 2 || mantissa === 5))) return "";
      if (power >= -3 && power <= 4) return String(Number(v.toPrecision(1)));
      return (mantissa === 1 ? "10" : mantissa + "·10") + raised(power);
    });
    const stroke = name => () => css(name);
    const short = name => (window.innerWidth <= 640 ? name.split(" ")[0] : name);
    const widest = Math.max(0, ...rows.map(name => short(name).length));
    return {
      scale: key,
      stroke: stroke("--text"),
      grid: { stroke: stroke("--line"), width: 1 },
      ticks: { stroke: stroke("--line"), width: 1 },
      font: "12px system-ui, sans-serif",
      labelFont: "13px system-ui, sans-serif",
      labelSize: 22,
      label: own.label === "" && own.unit === "" ? undefined : u => {
        const unit = PREFIX[exponent(u)] + own.unit;
        return unit === "" ? own.label : own.label + ", " + unit;
      },
      ...(rows.length > 0
        ? { splits: () => rows.map((_, k) => k), values: () => rows.map(short), size: 20 + 7 * widest }
        : { filter: own.log ? (_, splits) => splits : undefined, values: own.log ? decades : plain, size: key === "y" ? 56 : 34, space: key === "y" ? 34 : 56 }),
    };
  };

  const series = (figure, s) => {
    const stroke = () => css("--c" + s.colour);
    const dots = s.style === "dots";
    return {
      label: s.name || " ",
      stroke,
      width: dots ? 0 : 1.5,
      // Whole pixels would make stairs of slopes.
      pxAlign: 0,
      dash: s.dash ? [6, 4] : undefined,
      paths: dots ? () => null : s.style === "step" ? uPlot.paths.stepped({ align: 1 }) : uPlot.paths.linear(),
      points: { show: dots, size: 5, fill: stroke, stroke, width: 0 },
      value: (_, v) => (figure.rows.length > 0 && v != null ? figure.rows[Math.round(v)] ?? "–" : quantity(figure.y, v)),
    };
  };

  const options = (figure, width, height, data) => {
    const ends = [data[0][0], data[0][data[0].length - 1]];
    const rows = figure.rows.length > 0;
    const far = (a, b) => (a <= ends[0] && b >= ends[1] ? figure.x.ends : [a, b]);
    const y = rows ? { range: [-0.6, figure.rows.length - 0.4], dir: -1 } : { distr: figure.y.log ? 3 : 1 };
    return {
      width,
      height,
      scales: { x: { time: false, distr: figure.x.log ? 3 : 1, range: (_, a, b) => far(a, b) }, y },
      axes: [axis(figure.x, "x", []), axis(figure.y, "y", figure.rows)],
      series: [
        { label: figure.x.label, value: (_, v) => quantity(figure.x, v) },
        ...figure.series.map(s => series(figure, s)),
      ],
      legend: {
        markers: {
          width: () => 3,
          dash: (u, k) => (u.series[k].dash ? "dashed" : "solid"),
          stroke: (_, k) => "var(--c" + figure.series[k - 1].colour + ")",
          fill: () => "none",
        },
      },
      cursor: {
        drag: { x: true, y: !rows, uni: 24 },
        points: { size: 7 },
        sync: figure.link === "" ? undefined : { key: figure.link, setSeries: false, scales: ["x", null] },
      },
    };
  };

  // A legend that the keyboard reaches.
  const reachable = u => {
    u.root.querySelectorAll(".u-series").forEach((row, k) => {
      const name = row.querySelector("th");
      if (k === 0) return;
      name.tabIndex = 0;
      name.setAttribute("role", "switch");
      const announce = () => name.setAttribute("aria-checked", String(u.series[k].show));
      announce();
      name.addEventListener("click", announce);
      name.addEventListener("keydown", e => {
        if (e.key !== "Enter" && e.key !== " ") return;
        e.preventDefault();
        name.click();
      });
    });
  };

  const begin = (holder, text) => {
    const figure = JSON.parse(text);
    const drawing = holder.querySelector(".drawing");
    const box = drawing.getBoundingClientRect();
    const data = aligned(figure);
    const live = document.createElement("div");
    live.className = "plot";
    drawing.after(live);
    holder.classList.add("live");
    const u = new uPlot(options(figure, Math.floor(box.width), Math.round(box.height), data), data, live);
    holder.plot = u;
    reachable(u);
    // Names alone until the pointer, or that of a linked figure, is over the curves.
    u.hooks.setCursor = [() => u.root.classList.toggle("pointed", u.cursor.idx != null)];
    const group = linked.get(figure.link) ?? [];
    const zoomed = group.find(other => other.holder.classList.contains("zoomed"));
    group.push({ holder, u });
    if (figure.link !== "") linked.set(figure.link, group);
    const full = { ...u.scales.x };
    u.hooks.setScale = [(_, key) => {
      const all = u.scales.x.min === full.min && u.scales.x.max === full.max;
      if (key === "x") holder.classList.toggle("zoomed", !all);
    }];
    if (zoomed) u.setScale("x", { min: zoomed.u.scales.x.min, max: zoomed.u.scales.x.max });
    new ResizeObserver(() => {
      const width = Math.floor(live.clientWidth);
      if (width > 0 && width !== u.width) u.setSize({ width, height: u.height });
    }).observe(live);
  };

  document.documentElement.classList.add("scripted");
  // A figure is drawn when it comes near the window.
  const watch = new IntersectionObserver(entries => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      watch.unobserve(target);
      begin(target, target.querySelector("script").textContent);
    }
  }, { rootMargin: "400px" });
  document.querySelectorAll("figure:has(> script)").forEach(figure => watch.observe(figure));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    document.querySelectorAll("figure.live").forEach(figure => figure.plot.redraw(false));
  });
})();
