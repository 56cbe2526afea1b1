// SPDX-License-Identifier: Apache-2.0
// Short lessons with questions that check themselves; each loads a lens to look at.

import { fixed, parseNumber, signed } from "../app/format";
import { DEFAULT_ORDER, type EyeRx } from "../app/order";
import type { Store } from "../app/store";
import { t, type TextKey } from "../app/texts";
import { view } from "../app/view";
import { h, uniqueId } from "../ui/dom";
import { LESSONS, type Lesson, type Question } from "./lesson_list";
import type { MapKind } from "./maps";

type Verdict = (right: boolean) => void;

function verdictLine(): { line: HTMLElement; say: (right: boolean, text: string) => void } {
  const line = h("p", { class: "verdict-line", role: "status" });
  return {
    line,
    say(right, text) {
      line.className = `verdict-line ${right ? "right" : "wrong"}`;
      line.textContent = `${t(right ? "lessons.right" : "lessons.wrong")} ${text}`;
    },
  };
}

function numberQuestion(key: string, q: Question & { kind: "number" }, done: Verdict): HTMLElement {
  const id = uniqueId("answer");
  const input = h("input", { id, type: "text", inputmode: "decimal", autocomplete: "off" });
  const { line, say } = verdictLine();
  const check = (event: Event): void => {
    event.preventDefault();
    const value = parseNumber(input.value);
    if (Number.isNaN(value)) return say(false, t("lessons.wantNumber"));
    const right = Math.abs(value - q.answer) <= q.tolerance;
    const places = q.unit === "°" ? 0 : q.tolerance < 0.01 ? 3 : 2;
    const shown = q.unit === "D" ? signed(q.answer, places) : fixed(q.answer, places);
    say(right, right ? t(`${key}.why` as TextKey, { answer: `${shown} ${q.unit}` })
      : t("lessons.tryAgain"));
    done(right);
  };
  return h("form", { class: "question", onsubmit: check },
    h("label", { for: id }, t(key as TextKey)),
    h("div", { class: "answer" }, input, h("span", { class: "unit" }, q.unit),
      h("button", { type: "submit", class: "quiet" }, t("lessons.check"))),
    line);
}

function choiceQuestion(key: string, q: Question & { kind: "choice" }, done: Verdict): HTMLElement {
  const { line, say } = verdictLine();
  const name = uniqueId("choice");
  const options = Array.from({ length: q.options }, (_, i) =>
    h("label", {}, h("input", { type: "radio", name, value: i, onchange: () => {
      const right = i === q.answer;
      say(right, t(right ? (`${key}.why` as TextKey) : "lessons.tryAgain"));
      done(right);
    } }), t(`${key}.${"abc"[i]}` as TextKey)));
  return h("fieldset", { class: "question" }, h("legend", {}, t(key as TextKey)), ...options, line);
}

export interface Openers {
  explain(key: string): void;
  map(kind: MapKind): void;
}

export function lessonsSection(store: Store, open: Openers): HTMLElement {
  const right = new Set<string>();
  const total = LESSONS.reduce((sum, lesson) => sum + lesson.questions.length, 0);
  const score = h("p", { class: "score", role: "status" });
  const marks = new Map<string, HTMLElement>();
  const showScore = (): void => {
    score.textContent = t("lessons.score", { right: right.size, total });
    for (const lesson of LESSONS) {
      const all = lesson.questions.every((_, i) => right.has(`${lesson.id}${i}`));
      marks.get(lesson.id)!.textContent = all ? t("lessons.done") : "";
    }
  };

  function load(lesson: Lesson): void {
    const { rx, other, ...rest } = lesson.lens;
    const eye: EyeRx = { ...DEFAULT_ORDER.right, ...rx };
    store.take({ ...DEFAULT_ORDER, ...rest, right: eye, left: { ...eye, ...other } });
    if (lesson.explain) return open.explain(lesson.explain);
    if (lesson.map) open.map(lesson.map);
    view.openTab(lesson.look);
    document.getElementById(`tab-${lesson.look}`)?.focus();
  }
  const cards = LESSONS.map((lesson, i) => {
    const key = `lesson.${lesson.id}`;
    const mark = h("span", { class: "lesson-mark" });
    marks.set(lesson.id, mark);
    return h("details", { class: "lesson", id: `lesson-${lesson.id}`, open: i === 0 },
      h("summary", {}, h("span", {}, `${i + 1}. ${t(`${key}.title` as TextKey)}`), mark),
      ...Array.from({ length: lesson.paragraphs }, (_, k) =>
        h("p", {}, t(`${key}.p${k + 1}` as TextKey))),
      h("button", { type: "button", class: "quiet", onclick: () => load(lesson) },
        t("lessons.load")),
      ...lesson.questions.map((q, k) => {
        const verdict: Verdict = (isRight) => {
          if (isRight) right.add(`${lesson.id}${k}`);
          showScore();
        };
        const at = `${key}.q${k + 1}`;
        return q.kind === "number" ? numberQuestion(at, q, verdict) : choiceQuestion(at, q, verdict);
      }));
  });
  showScore();
  return h("section", { class: "card lessons" }, h("h2", {}, t("lessons.title")),
    h("p", {}, t("lessons.intro")), score, ...cards);
}
