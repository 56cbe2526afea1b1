// SPDX-License-Identifier: Apache-2.0
import "./style.css";

import { Engine } from "./app/engine";
import { fillMedia } from "./app/media";
import { DEFAULT_ORDER, fromLink, toLink } from "./app/order";
import { Store } from "./app/store";
import { hasText, t, type TextKey } from "./app/texts";
import { applyTheme, themeButton } from "./ui/theme";
import { view } from "./app/view";
import { costSection } from "./sections/cost";
import { eyesSection } from "./sections/eyes";
import { lensSection } from "./sections/lens";
import { lessonsSection } from "./sections/lessons";
import { mapsSection } from "./sections/maps";
import { numbersSection } from "./sections/numbers";
import { orderForm } from "./sections/order";
import { practiceSection } from "./sections/practice";
import { raysSection } from "./sections/rays";
import { solidSection } from "./sections/solid";
import { whySection } from "./sections/why";
import { h } from "./ui/dom";

const TABS = ["overview", "rays", "maps", "why", "lessons", "practice", "solid", "cost"] as const;
type Tab = (typeof TABS)[number];

function tabBar(panels: Record<Tab, HTMLElement>): HTMLElement {
  const buttons = TABS.map((tab) =>
    h("button", { type: "button", role: "tab", id: `tab-${tab}`, "aria-controls": `panel-${tab}`,
      onclick: () => view.openTab(tab) }, t(`tab.${tab}` as TextKey)));
  const bar = h("div", { class: "tabs", role: "tablist", "aria-label": t("tab.all") }, ...buttons);
  bar.addEventListener("keydown", (event) => {
    const at = TABS.indexOf(view.tab as Tab);
    const to: Record<string, number> = {
      ArrowRight: (at + 1) % TABS.length,
      ArrowLeft: (at + TABS.length - 1) % TABS.length,
      Home: 0,
      End: TABS.length - 1,
    };
    if (!(event.key in to)) return;
    event.preventDefault();
    view.openTab(TABS[to[event.key]]);
    buttons[to[event.key]].focus();
  });
  const show = (): void => {
    TABS.forEach((tab, i) => {
      const open = tab === view.tab;
      buttons[i].setAttribute("aria-selected", String(open));
      buttons[i].tabIndex = open ? 0 : -1;
      panels[tab].hidden = !open;
    });
  };
  view.onChange(show);
  show();
  return bar;
}

// A view that is not made before it is first opened.
function whenOpened(tab: Tab, make: () => HTMLElement): HTMLElement {
  const place = h("div");
  const look = (): void => {
    if (view.tab === tab && !place.hasChildNodes()) place.append(make());
  };
  view.onChange(look);
  look();
  return place;
}

async function start(app: HTMLElement): Promise<void> {
  applyTheme();
  document.title = t("page.title");
  const engine = await Engine.load();
  fillMedia(engine.media());
  const store = new Store(engine, fromLink(location.hash), DEFAULT_ORDER);
  const linkedTab = new URLSearchParams(location.hash.slice(1)).get("tab") ?? "";
  if (TABS.includes(linkedTab as Tab)) view.tab = linkedTab;

  const open = (tab: Tab) => (): boolean => view.tab === tab;
  const why = whySection(store, open("why"));
  const explain = (key: string): void => {
    view.openTab("why");
    why.open(key);
  };
  const maps = mapsSection(store, open("maps"));
  const panels: Record<Tab, HTMLElement> = {
    overview: h("div", { class: "overview" },
      eyesSection(store, open("overview"), explain),
      numbersSection(store, open("overview"), explain),
      lensSection(store, open("overview"))),
    rays: raysSection(store, open("rays")),
    maps: maps.root,
    why: why.root,
    lessons: lessonsSection(store, { explain, map: maps.choose }),
    practice: whenOpened("practice", () => practiceSection(engine)),
    solid: solidSection(store, open("solid")),
    cost: costSection(open("cost")),
  };
  for (const tab of TABS) {
    panels[tab] = h("div", { role: "tabpanel", id: `panel-${tab}`, "aria-labelledby": `tab-${tab}`,
      class: `panel panel-${tab}` }, panels[tab]);
  }
  const stale = h("p", { class: "stale", hidden: true }, t("error.stale"));
  store.onProblem((problem) => {
    stale.hidden = problem === null;
  });
  view.onChange(() => store.refresh());

  let pending = 0;
  store.onLenses(({ order }) => {
    window.clearTimeout(pending);
    pending = window.setTimeout(() => history.replaceState(null, "", `#${toLink(order)}`), 300);
  });
  window.addEventListener("hashchange", () => store.take(fromLink(location.hash)));

  app.replaceChildren(
    h("a", { class: "skip", href: "#panels", onclick: (event: Event) => {
      event.preventDefault();
      document.getElementById("panels")?.focus();
    } }, t("page.skip")),
    h("header", {},
      h("div", { class: "brand" }, h("img", { src: "./icon.svg", alt: "", width: 30, height: 30 }),
        h("div", {}, h("h1", {}, "Lorgnette"), h("p", {}, t("page.subtitle")))),
      themeButton(() => view.openTab(view.tab))),
    h("div", { class: "layout" },
      h("aside", { "aria-label": t("order.title") }, orderForm(store)),
      h("main", { id: "panels", tabindex: -1 }, tabBar(panels), stale,
        ...TABS.map((tab) => panels[tab]))),
    h("footer", {}, h("p", {}, t("page.footer"))),
  );
  store.refresh();
  document.documentElement.dataset.ready = "true";
  // Read by web/tests/speed.mjs: everything of the first view stands.
  performance.mark("first view");
}

const app = document.getElementById("app")!;
start(app).catch((error: unknown) => {
  const text = hasText("page.failed") ? t("page.failed") : "";
  app.replaceChildren(h("p", { class: "problem", role: "alert" }, `${text} ${String(error)}`));
});
