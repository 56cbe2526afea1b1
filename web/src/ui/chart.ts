// SPDX-License-Identifier: Apache-2.0
// A small line chart by uPlot in the page's colours.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { h } from "./dom";

export interface ChartSeries {
  label: string;
  colour: string; // a custom property of the page
  dash?: number[];
}

export interface Chart {
  root: HTMLElement;
  set(data: (number | null)[][]): void;
}

const HEIGHT = 240;

export function chart(xLabel: string, yLabel: string, series: ChartSeries[]): Chart {
  const root = h("div", { class: "chart" });
  let plot: uPlot | null = null;
  let data: uPlot.AlignedData = [[0], ...series.map(() => [0])] as uPlot.AlignedData;
  const colour = (name: string): string =>
    getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  function build(): void {
    plot?.destroy();
    const axis = (label: string): uPlot.Axis => ({
      label,
      labelSize: 22,
      stroke: colour("--soft"),
      grid: { stroke: colour("--line") },
      ticks: { stroke: colour("--line") },
    });
    plot = new uPlot(
      {
        pxAlign: false,
        width: Math.max(220, root.clientWidth || 420),
        height: HEIGHT,
        scales: { x: { time: false } },
        axes: [axis(xLabel), axis(yLabel)],
        series: [
          { label: xLabel },
          ...series.map((one) => ({
            label: one.label,
            stroke: colour(one.colour),
            width: 2,
            dash: one.dash,
            points: { show: false },
            value: (_: uPlot, v: number | null) => (v === null ? "–" : v.toFixed(3)),
          })),
        ],
      },
      data,
      root,
    );
  }
  let width = 0;
  new ResizeObserver(() => {
    if (Math.abs(root.clientWidth - width) < 2 || root.clientWidth === 0) return;
    width = root.clientWidth;
    build();
  }).observe(root);
  const again = (): void => {
    if (plot) build();
  };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  new MutationObserver(again).observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
  return {
    root,
    set(next) {
      data = next as uPlot.AlignedData;
      plot?.setData(data);
    },
  };
}
