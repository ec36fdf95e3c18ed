#include "pipeline/procedure/words.h"

#include <algorithm>
#include <array>
#include <utility>

namespace pleinair::procedure {
namespace {

// Signal words as ANSI Z535 and DIN EN 82079-1 have them, and as is usual in the other languages.
constexpr std::array<Words, 8> kWords{{
    {.language = "en",
     .step = "Step",
     .tools = "Tools",
     .torque = "Torque",
     .check = "Check",
     .end = "end",
     .theEnd = "The end",
     .aborted = "Aborted",
     .photo = "Take a photo",
     .comparison = "Compare with the picture",
     .yes = "yes",
     .no = "no",
     .ok = "within limits",
     .low = "too low",
     .high = "too high",
     .pass = "pass",
     .fail = "fail",
     .uncertain = "uncertain",
     .done = "done",
     .danger = "DANGER",
     .warning = "WARNING",
     .caution = "CAUTION",
     .notice = "NOTICE",
     .pressDone = "Page Down: done",
     .pressPhoto = "Page Down: photo",
     .pressValue = "then Enter",
     .pressCompare = "Page Down, or y (equal), n (not), u (uncertain)",
     .pressSignOff = "Enter: sign off",
     .pressBack = "Page Up: back",
     .noTag = "No tag of the machine in view",
     .tagCovered = "The tag is covered",
     .moveCloser = "Place too uncertain: move closer",
     .notInView = "The part is not in view",
     .otherTag = "Tag of another machine",
     .tagsContradict = "Tags contradict each other: check sizes and places"},
    {.language = "de",
     .step = "Schritt",
     .tools = "Werkzeug",
     .torque = "Drehmoment",
     .check = "Prüfung",
     .end = "Ende",
     .theEnd = "Ende",
     .aborted = "Abgebrochen",
     .photo = "Foto aufnehmen",
     .comparison = "Mit dem Bild vergleichen",
     .yes = "ja",
     .no = "nein",
     .ok = "im Bereich",
     .low = "zu klein",
     .high = "zu groß",
     .pass = "bestanden",
     .fail = "nicht bestanden",
     .uncertain = "unklar",
     .done = "erledigt",
     .danger = "GEFAHR",
     .warning = "WARNUNG",
     .caution = "VORSICHT",
     .notice = "HINWEIS",
     .pressDone = "Bild ab: fertig",
     .pressPhoto = "Bild ab: Foto",
     .pressValue = "dann Eingabetaste",
     .pressCompare = "Bild ab, oder y (gleich), n (nicht), u (unklar)",
     .pressSignOff = "Eingabetaste: abzeichnen",
     .pressBack = "Bild auf: zurück",
     .noTag = "Kein Tag der Maschine im Bild",
     .tagCovered = "Tag verdeckt",
     .moveCloser = "Lage zu ungenau: näher herangehen",
     .notInView = "Teil nicht im Bild",
     .otherTag = "Tag einer anderen Maschine",
     .tagsContradict = "Tags widersprechen sich: Größen und Plätze prüfen"},
    {.language = "es",
     .step = "Paso",
     .tools = "Herramientas",
     .torque = "Par",
     .check = "Control",
     .end = "fin",
     .theEnd = "Fin",
     .aborted = "Interrumpido",
     .photo = "Tomar una foto",
     .comparison = "Comparar con la imagen",
     .yes = "sí",
     .no = "no",
     .ok = "dentro de los límites",
     .low = "demasiado bajo",
     .high = "demasiado alto",
     .pass = "conforme",
     .fail = "no conforme",
     .uncertain = "dudoso",
     .done = "hecho",
     .danger = "PELIGRO",
     .warning = "ADVERTENCIA",
     .caution = "PRECAUCIÓN",
     .notice = "AVISO",
     .pressDone = "Av Pág: hecho",
     .pressPhoto = "Av Pág: foto",
     .pressValue = "luego Intro",
     .pressCompare = "Av Pág, o y (igual), n (distinto), u (dudoso)",
     .pressSignOff = "Intro: firmar",
     .pressBack = "Re Pág: atrás",
     .noTag = "Ninguna etiqueta de la máquina a la vista",
     .tagCovered = "La etiqueta está tapada",
     .moveCloser = "Posición incierta: acérquese",
     .notInView = "La pieza no está a la vista",
     .otherTag = "Etiqueta de otra máquina",
     .tagsContradict = "Las etiquetas se contradicen: compruebe tamaños y lugares"},
    {.language = "fr",
     .step = "Étape",
     .tools = "Outils",
     .torque = "Couple",
     .check = "Contrôle",
     .end = "fin",
     .theEnd = "Fin",
     .aborted = "Interrompu",
     .photo = "Prendre une photo",
     .comparison = "Comparer avec l’image",
     .yes = "oui",
     .no = "non",
     .ok = "dans les limites",
     .low = "trop bas",
     .high = "trop haut",
     .pass = "conforme",
     .fail = "non conforme",
     .uncertain = "douteux",
     .done = "fait",
     .danger = "DANGER",
     .warning = "AVERTISSEMENT",
     .caution = "ATTENTION",
     .notice = "AVIS",
     .pressDone = "Page suivante : fait",
     .pressPhoto = "Page suivante : photo",
     .pressValue = "puis Entrée",
     .pressCompare = "Page suivante, ou y (égal), n (différent), u (douteux)",
     .pressSignOff = "Entrée : signer",
     .pressBack = "Page précédente : retour",
     .noTag = "Aucun repère de la machine en vue",
     .tagCovered = "Le repère est masqué",
     .moveCloser = "Position incertaine : approchez-vous",
     .notInView = "La pièce n’est pas en vue",
     .otherTag = "Repère d’une autre machine",
     .tagsContradict = "Les repères se contredisent : vérifier tailles et places"},
    {.language = "it",
     .step = "Passo",
     .tools = "Attrezzi",
     .torque = "Coppia",
     .check = "Controllo",
     .end = "fine",
     .theEnd = "Fine",
     .aborted = "Interrotto",
     .photo = "Scattare una foto",
     .comparison = "Confrontare con l’immagine",
     .yes = "sì",
     .no = "no",
     .ok = "nei limiti",
     .low = "troppo basso",
     .high = "troppo alto",
     .pass = "conforme",
     .fail = "non conforme",
     .uncertain = "incerto",
     .done = "fatto",
     .danger = "PERICOLO",
     .warning = "AVVERTENZA",
     .caution = "ATTENZIONE",
     .notice = "AVVISO",
     .pressDone = "Pag giù: fatto",
     .pressPhoto = "Pag giù: foto",
     .pressValue = "poi Invio",
     .pressCompare = "Pag giù, oppure y (uguale), n (diverso), u (incerto)",
     .pressSignOff = "Invio: firmare",
     .pressBack = "Pag su: indietro",
     .noTag = "Nessun tag della macchina in vista",
     .tagCovered = "Il tag è coperto",
     .moveCloser = "Posizione incerta: avvicinarsi",
     .notInView = "Il pezzo non è in vista",
     .otherTag = "Tag di un’altra macchina",
     .tagsContradict = "I tag si contraddicono: controllare misure e posti"},
    {.language = "nl",
     .step = "Stap",
     .tools = "Gereedschap",
     .torque = "Aanhaalmoment",
     .check = "Controle",
     .end = "einde",
     .theEnd = "Einde",
     .aborted = "Afgebroken",
     .photo = "Maak een foto",
     .comparison = "Vergelijk met de afbeelding",
     .yes = "ja",
     .no = "nee",
     .ok = "binnen de grenzen",
     .low = "te laag",
     .high = "te hoog",
     .pass = "goed",
     .fail = "fout",
     .uncertain = "onzeker",
     .done = "klaar",
     .danger = "GEVAAR",
     .warning = "WAARSCHUWING",
     .caution = "VOORZICHTIG",
     .notice = "LET OP",
     .pressDone = "Page Down: klaar",
     .pressPhoto = "Page Down: foto",
     .pressValue = "dan Enter",
     .pressCompare = "Page Down, of y (gelijk), n (niet), u (onzeker)",
     .pressSignOff = "Enter: aftekenen",
     .pressBack = "Page Up: terug",
     .noTag = "Geen tag van de machine in beeld",
     .tagCovered = "De tag is bedekt",
     .moveCloser = "Plaats te onzeker: kom dichterbij",
     .notInView = "Het onderdeel is niet in beeld",
     .otherTag = "Tag van een andere machine",
     .tagsContradict = "Tags spreken elkaar tegen: controleer maten en plaatsen"},
    {.language = "pl",
     .step = "Krok",
     .tools = "Narzędzia",
     .torque = "Moment",
     .check = "Kontrola",
     .end = "koniec",
     .theEnd = "Koniec",
     .aborted = "Przerwano",
     .photo = "Zrób zdjęcie",
     .comparison = "Porównaj z obrazem",
     .yes = "tak",
     .no = "nie",
     .ok = "w granicach",
     .low = "za mało",
     .high = "za dużo",
     .pass = "zgodne",
     .fail = "niezgodne",
     .uncertain = "niepewne",
     .done = "gotowe",
     .danger = "NIEBEZPIECZEŃSTWO",
     .warning = "OSTRZEŻENIE",
     .caution = "PRZESTROGA",
     .notice = "UWAGA",
     .pressDone = "Page Down: gotowe",
     .pressPhoto = "Page Down: zdjęcie",
     .pressValue = "potem Enter",
     .pressCompare = "Page Down albo y (zgodne), n (nie), u (niepewne)",
     .pressSignOff = "Enter: podpisz",
     .pressBack = "Page Up: wstecz",
     .noTag = "Brak znacznika maszyny w kadrze",
     .tagCovered = "Znacznik jest zasłonięty",
     .moveCloser = "Położenie niepewne: podejdź bliżej",
     .notInView = "Części nie ma w kadrze",
     .otherTag = "Znacznik innej maszyny",
     .tagsContradict = "Znaczniki są sprzeczne: sprawdź rozmiary i miejsca"},
    {.language = "pt",
     .step = "Passo",
     .tools = "Ferramentas",
     .torque = "Binário",
     .check = "Verificação",
     .end = "fim",
     .theEnd = "Fim",
     .aborted = "Interrompido",
     .photo = "Tirar uma foto",
     .comparison = "Comparar com a imagem",
     .yes = "sim",
     .no = "não",
     .ok = "dentro dos limites",
     .low = "demasiado baixo",
     .high = "demasiado alto",
     .pass = "conforme",
     .fail = "não conforme",
     .uncertain = "incerto",
     .done = "feito",
     .danger = "PERIGO",
     .warning = "ADVERTÊNCIA",
     .caution = "CUIDADO",
     .notice = "AVISO",
     .pressDone = "Page Down: feito",
     .pressPhoto = "Page Down: foto",
     .pressValue = "depois Enter",
     .pressCompare = "Page Down, ou y (igual), n (diferente), u (incerto)",
     .pressSignOff = "Enter: assinar",
     .pressBack = "Page Up: voltar",
     .noTag = "Nenhuma etiqueta da máquina à vista",
     .tagCovered = "A etiqueta está tapada",
     .moveCloser = "Posição incerta: aproxime-se",
     .notInView = "A peça não está à vista",
     .otherTag = "Etiqueta de outra máquina",
     .tagsContradict = "As etiquetas contradizem-se: verifique tamanhos e lugares"},
}};

}  // namespace

const Words& wordsIn(std::string_view language) {
  const std::string_view first = language.substr(0, language.find('-'));
  const auto found = std::ranges::find(kWords, first, &Words::language);
  return found != kWords.end() ? *found : kWords.front();
}

std::span<const Words> allWords() {
  return kWords;
}

std::string withDecimals(std::string text, std::string_view language) {
  if (wordsIn(language).language == kWords.front().language) return text;
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == '.' && isDigit(text[i - 1]) && isDigit(text[i + 1])) text[i] = ',';
  }
  return text;
}

std::string_view wordOf(const Words& words, Outcome outcome) {
  switch (outcome) {
    case Outcome::kDone:
    case Outcome::kTaken:
      return words.done;
    case Outcome::kYes:
      return words.yes;
    case Outcome::kNo:
      return words.no;
    case Outcome::kOk:
      return words.ok;
    case Outcome::kLow:
      return words.low;
    case Outcome::kHigh:
      return words.high;
    case Outcome::kPass:
      return words.pass;
    case Outcome::kFail:
      return words.fail;
    case Outcome::kUncertain:
      return words.uncertain;
  }
  return {};
}

std::string_view wordOf(const Words& words, WarningLevel level) {
  switch (level) {
    case WarningLevel::kDanger:
      return words.danger;
    case WarningLevel::kWarning:
      return words.warning;
    case WarningLevel::kCaution:
      return words.caution;
    case WarningLevel::kNotice:
      return words.notice;
  }
  return {};
}

}  // namespace pleinair::procedure
